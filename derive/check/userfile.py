"""Read a claims file in TOML, which is data only: no part of it is ever executed.

In:   the path of a file, or of a folder with several.
Out:  the Paper with all claims, and the readings that wait for the user.

docs/claims.md describes the file.
"""

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from os.path import isdir
from pathlib import Path
from typing import Any

from derive.check.claim import Claim, Paper
from derive.check.claim_table import ClaimReader
from derive.check.declarations import Declarations
from derive.check.mistakes import Collected
from derive.check.printed import Reading
from derive.check.schema import ClaimsFile, Place, lines_in, record, value
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
        return _read(path)[0]
    papers = [_read(each)[0] for each in sorted(path.glob("*.toml"))]
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


def open_readings(path: Path) -> list[Reading]:
    """Return the readings that are not accepted yet, and the claims in LaTeX that cannot be read.

    Raises the errors of `read_claims`.
    """
    return _read(path)[1]


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
    except tomllib.TOMLDecodeError as error:
        why = f"the file is not valid TOML ({error})"
    except (Unreadable, ValueError) as error:
        why = str(error)
        if "digits" in why:
            why = "the file cannot be read (an integer has too many digits)"
    raise BadClaimsFile(str(path), why, remedy)


def _read(path: Path) -> tuple[Paper, list[Reading]]:
    """Read one file; errors in its structure are collected and reported together."""
    text, data = source(path)
    errors, place = Collected(), Place(str(path), lines_in(text))
    for each in _texts(data):
        with errors.noted():
            is_plain = each.replace("\n", "").replace("\t", "").isprintable()
            why = f"the string {each!r} contains a control character"
            place.demand(is_plain, why, "remove it")
    errors.demand_none()
    file = record(ClaimsFile, data, place, errors.noted)
    reader = ClaimReader(Declarations(file, place, errors))
    claims = _claims(file.claims, place, reader, errors)
    if errors.errors:
        errors.errors += reader.mistakes
    errors.demand_none()
    signs = {name: tuple(labels) for name, labels in file.signs.items()}
    return Paper(file.title or str(path), claims, signs), reader.readings


def _claims(
    given: list[Any], place: Place, reader: ClaimReader, errors: Collected
) -> tuple[Claim, ...]:
    """Read all claims; each must be a table with a label of its own."""
    with errors.noted():
        place.demand(bool(given), "the file has no [[claims]]", "add at least one")
        why = f"the file has {len(given)} claims, and at most {_MAX_CLAIMS} are allowed"
        place.demand(len(given) <= _MAX_CLAIMS, why, "split it")
    made, labels = list[Claim](), set[str]()
    for number, each in enumerate(given if len(given) <= _MAX_CLAIMS else (), start=1):
        at = place.at("claims", number)
        with errors.noted():
            is_table = isinstance(each, dict)
            remedy = "write [[claims]] before each claim"
            at.demand(is_table, f"claim {number} is not a table", remedy)
            label = value("label", each.get("label", ""), str, at.inside(f"claim {number}"))
            why = f"two claims have the label {label!r}"
            at.demand(label not in labels, why, "give each claim a different label")
            labels.add(label)
            made.append(reader.claim(number, each, at.inside(f"claim {label!r}")))
    return tuple(made)


def _texts(data: object) -> Iterator[str]:
    """Yield all keys and texts of a file, at any nesting depth."""
    left = [data]
    while left:
        each = left.pop()
        if isinstance(each, str):
            yield each
        elif isinstance(each, Mapping):
            left += [*each, *each.values()]
        elif isinstance(each, list):
            left += each
