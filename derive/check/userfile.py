"""Read a claims file in TOML, which is data only: no part of it is ever executed.

In:   the path of a file, or of a folder with several.
Out:  the Paper with all claims, and what the file declares for them.

docs/claims.md describes the file.
"""

import re
import tomllib
from functools import cache
from os.path import isdir
from pathlib import Path
from typing import Any

from derive.check.claim import Claim, Paper
from derive.check.claim_table import ClaimReader
from derive.check.declarations import Declarations
from derive.check.mistakes import Collected
from derive.check.schema import ClaimsFile, Labelled, Place, decoded, lines_in
from derive.command.errors import BadClaimsFile
from derive.command.files import Unreadable, bytes_of

BUILT_IN = Path(__file__).parent / "andresen2020"
"""The claims files of the paper that introduced the method of this project."""

_LARGEST = 200_000
"""The largest size of a claims file, in bytes."""
_MAX_CLAIMS = 500
"""The largest number of claims in a file."""
_MAX_LEVELS = 8
"""The number of levels of tables and lists that is enough for every claims file."""


def read_claims(path: Path) -> Paper:
    """Read the claims of a file, or of all files in a folder in the order of their names.

    Raises BadClaimsFile or BadFormula for one error, and Mistakes for several.  A claim that cannot
    be read or compared is returned as unchecked, with the reason.
    """
    if not isdir(path):  # noqa: PTH112 - False for a name that no file can have
        return read_file(path)[0]
    papers = [read_file(each)[0] for each in sorted(path.glob("*.toml"))]
    if not papers:
        why = "the folder has no claims file"
        raise BadClaimsFile(str(path), why, "give a claims file, or a folder with such files")
    signs = dict[str, tuple[str, ...]]()
    for each in papers:
        signs |= {name: signs.get(name, ()) + labels for name, labels in each.signs.items()}
    return Paper(papers[0].title, tuple(c for each in papers for c in each.claims), signs)


@cache
def built_in() -> Paper:
    """Return the paper that introduced the method of this project."""
    return read_claims(BUILT_IN)


def source(path: Path) -> tuple[str, dict[str, Any]]:
    """Return a claims file as text and as data; raises BadClaimsFile."""
    remedy = "give a claims file; `derive check paper.tex --draft FILE` writes one from a paper"
    try:
        text = bytes_of(path, _LARGEST).decode("utf-8-sig")
        return text, tomllib.loads(text)
    except RecursionError:
        why = f"its tables are nested too deeply, and at most {_MAX_LEVELS} levels are allowed"
    except UnicodeDecodeError:
        why = "the file is not UTF-8 text"
    except Unreadable as error:
        why = str(error)
    except ValueError as error:
        why = f"the file is not valid TOML ({error})"
    raise BadClaimsFile(str(path), why, remedy)


def read_file(path: Path) -> tuple[Paper, Declarations]:
    """Read one file; errors in its structure are collected and reported together."""
    text, data = source(path)
    errors, place = Collected(), Place(str(path), lines_in(text))
    hidden = _unprintable(data)
    place.demand(not hidden, f"the text {hidden!r} contains a control character", "remove it")
    file = decoded(ClaimsFile, data, place, errors.noted)
    reader = ClaimReader(Declarations(file, place, errors))
    tables = [each for each in file.claims if isinstance(each, dict)]
    errors += reader.wrong_symbols(each.get("body") for each in tables)
    with errors.noted():
        why = f"the file has {len(file.claims) or 'no'} tables [[claims]]"
        is_right = data.get("claims") and len(file.claims) <= _MAX_CLAIMS
        place.demand(bool(is_right), why, f"write 1 to {_MAX_CLAIMS} of them")
        claims = _claims(file.claims, place, reader, errors)
    if errors:
        errors += reader.mistakes
    errors.demand_none()
    signs = {name: tuple(labels) for name, labels in file.signs.items()}
    return Paper(file.title or str(path), claims, signs), reader.declared


def _claims(
    given: list[Any], place: Place, reader: ClaimReader, errors: Collected
) -> tuple[Claim, ...]:
    """Read all claims; each must be a table with a label of its own."""
    made, labels = list[Claim](), set[str]()
    for number, each in enumerate(given, start=1):
        at = place.at("claims", number)
        with errors.noted():
            label = decoded(Labelled, each, at.inside(f"claim {number}")).label
            why = f"two claims have the label {label!r}"
            at.demand(label not in labels, why, "give each claim a different label")
            labels.add(label)
            made.append(reader.claim(each, at.inside(f"claim {label!r}")))
    return tuple(made)


def _unprintable(data: Any) -> str:
    """Return the first key or text, at any nesting depth, that a terminal cannot show."""
    found = [data]
    for each in found:
        if isinstance(each, dict):
            found += [*each, *each.values()]
        elif isinstance(each, list):
            found += each
        elif isinstance(each, str) and not re.sub(r"[\n\t]", "", each).isprintable():
            return each
    return ""
