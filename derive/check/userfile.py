"""Read a claims file in TOML, which is data only: no part of it is ever executed.

In:   the path of a file, or of a folder with several.
Out:  the Paper with all claims, and the readings that wait for the user.

    title = "..."
    seconds = 30                      # time limit for reading, for a verdict and for a correction
    body = "hertz"                    # its formulas may be called, such as load(a, c);
    # body = { g = "x**2/(2*R)", units = { R = "m" } }    or another body, or a geometry file

    [variables]                       # drawn at random; all else depends on them
    l = "half-width"                  # positive
    mu = { meaning = "x/l", low = -0.9, high = 0.9, unit = "-" }

    [symbols]                         # the source's symbols, which may refer to each other
    P = "load(l, l)"
    p_0 = { is = "2*P/(pi*l)", meaning = "largest pressure", unit = "Pa" }

    [latex]                           # LaTeX of symbols, if it differs from the names
    "E^*" = "E_star"

    [[claims]]
    label = "half-width"
    place = "eq. (3)"
    printed = "a**2 = 4*P*R/(pi*E_star)"       # or latex = '...' and understood = "..."
    part = 1                                   # the number of the statement in a LaTeX display
    accepted = true                            # false in a draft: not accepted yet
    expected = "fails"                         # the verdict, if it is known
    symbols = { M = "-moment(l, l)" }          # for this claim only, like `body`
    require = "b < w and x > 0"                # the conditions under which it is stated
    as = "c - x -> 0"                          # the ratio left/right tends to 1; or, with
    order = 1.5                                #   `order`, left - right is of this order
    given = ["(8)", "(11)"]                    # claims of the form symbol = ..., taken as true
    conventions = [{ what = "...", symbols = { ... }, contradicts = "..." }]
    ranges = { t = [0.4, 0.9] }                # ranges of variables in this claim
    through = "p = integral(h, s, 0, c)"       # the equation by which h = ... is judged
    allowed = { sigma = "..." }                # a bound is judged where it is just reached; it
    beyond = { sigma = "..." }                 #   must be true with `allowed`, not with `beyond`
    leading = true                             # ~ between leading terms is compared like =
    swaps = ["a", "c"]                         # symbols that may have been confused
    cases = [{ l = 1 }]                        # the only points that are used
    family = "large tension"                   # claims of one family share their points
    equation = "(3)"                           # the display to which it belongs
    against = "..."                            # what it is compared with, in words
    steps = ["..."]                            # the steps of the comparison
    consequence = "..."                        # the effect of the error on a user's results

    [signs]                                    # claims that show the sign of a quantity
    moment = ["(2)", "half-width"]

The body's parameters, E_star and f are always variables, and [variables] may give them a range.
The variables x, s and xi are positions, whose default range is symmetric about zero.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cache
from itertools import accumulate
from os.path import isdir
from pathlib import Path
from typing import Any

from derive.check.claim import Claim, Paper
from derive.check.claim_table import ClaimReader
from derive.check.context import Context
from derive.check.entries import Entries, Place, TimeLimit
from derive.check.lines import heads
from derive.check.meanings import Meanings
from derive.check.mistakes import Collected, demand_none
from derive.check.printed import Reading
from derive.check.variables import Variables, read_variables
from derive.command.errors import BadClaimsFile, UserError
from derive.command.files import Unreadable, bytes_of

BUILT_IN = Path(__file__).parent / "andresen2020"
"""The claims files of the paper that introduced the method of this project."""

_LARGEST = 200_000
"""The largest size of a claims file, in bytes."""
_MOST = 500
"""The largest number of claims in a file."""
_DEEPEST = 8
"""The number of levels of tables and lists that is enough for every claims file."""
_SECONDS = 30.0
"""The default time limit for reading a claim, for its verdict and its correction, in seconds."""
_MOST_SECONDS = 86_400
KEYS = frozenset({"title", "seconds", "body", "variables", "symbols", "latex", "claims", "signs"})
"""The keys of a claims file."""


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
    except Unreadable as error:
        raise BadClaimsFile(str(path), str(error), remedy) from error
    except tomllib.TOMLDecodeError as error:
        raise BadClaimsFile(str(path), f"the file is not valid TOML ({error})", remedy) from error
    except UnicodeDecodeError as error:
        raise BadClaimsFile(str(path), "the file is not UTF-8 text", remedy) from error
    except RecursionError:
        deep = _depth(text)
        why = f"its tables are nested {deep} deep, and at most {_DEEPEST} levels are allowed"
        raise BadClaimsFile(str(path), why, remedy) from None
    except ValueError as error:
        why = "an integer has too many digits" if "digits" in str(error) else str(error)
        raise BadClaimsFile(str(path), f"the file cannot be read ({why})", remedy) from error


def _depth(text: str) -> int:
    """Return how deep the brackets of a TOML text are nested, without those in strings."""
    brackets = re.findall(r"[][{}]", re.sub(r'"[^"\n]*"|\'[^\'\n]*\'', "", text))
    return max(accumulate(1 if each in "[{" else -1 for each in brackets))


def _read(path: Path) -> tuple[Paper, list[Reading]]:
    """Read one file; errors in its structure are collected and reported together."""
    text, data = source(path)
    errors, file = Collected(), Entries(Place(str(path)), data)
    for each in _texts(data):
        if not each.replace("\n", "").replace("\t", "").isprintable():
            why = f"the string {each!r} contains a control character"
            errors.errors.append(file.place.bad(why, "remove it"))
    demand_none(errors.errors)
    limit, tables = TimeLimit(_SECONDS), dict[str, Any]()
    with errors.noted():
        file.demand_known(KEYS)
    with errors.noted():
        file.demand_texts("title")
    with errors.noted():
        limit = _limit(file)
    variables = read_variables(file, text, errors)
    meanings = Meanings(file, text, variables, limit)
    meanings.read(_contexts(file, variables), errors)
    reader = ClaimReader(variables, meanings, limit)
    claims = _claims(file, text, reader, errors)
    with errors.noted():
        tables = file.table("signs")
    signs = dict[str, tuple[str, ...]]()
    with errors.noted():
        signs = {name: Entries(file.place.inside("signs"), tables).texts(name) for name in tables}
    if errors.errors:
        demand_none([*errors.errors, *reader.mistakes])
    return Paper(str(data.get("title", path)), claims, signs), reader.readings


def _limit(file: Entries) -> TimeLimit:
    given = file.data.get("seconds", _SECONDS)
    if type(given) not in (int, float) or not 0 < given <= _MOST_SECONDS:
        remedy = f"write a number above 0 and at most {_MOST_SECONDS}"
        raise file.place.bad(f"seconds = {given!r} is not a valid time limit", remedy)
    return TimeLimit(float(given))


def _contexts(file: Entries, variables: Variables) -> list[Context]:
    """Return the contexts of the file's body and of the bodies of its claims."""
    contexts, claims = [variables.file], file.data.get("claims", [])
    for given in claims if isinstance(claims, list) else []:
        with suppress(UserError):  # which makes this claim unchecked
            if isinstance(given, dict) and "body" in given:
                contexts.append(variables.of_body(given["body"], file.place))
    return contexts


def _claims(file: Entries, text: str, reader: ClaimReader, errors: Collected) -> tuple[Claim, ...]:
    """Read all claims; each must be a table with a label of its own."""
    given = file.data.get("claims", [])
    if not isinstance(given, list) or not given:
        errors.errors.append(file.place.bad("the file has no [[claims]]", "add at least one"))
        return ()
    if len(given) > _MOST:
        why = f"the file has {len(given)} claims, and at most {_MOST} are allowed"
        errors.errors.append(file.place.bad(why, "split it"))
        return ()
    lines = heads(text, len(given))
    made, labels = list[Claim](), set[str]()
    for number, each in enumerate(given, start=1):
        place = Place(file.place.file, lines[number - 1] if lines else None)
        with errors.noted():
            if not isinstance(each, dict):
                why = f"claim {number} is not a table"
                raise place.bad(why, "write [[claims]] before each claim")
            label = Entries(place.inside(f"claim {number}"), each).text("label")
            if label in labels:
                why = f"two claims have the label {label!r}"
                raise place.bad(why, "give each claim a different label")
            labels.add(label)
            entries = Entries(place.inside(f"claim {label!r}"), each)
            made.append(reader.claim(number, entries))
    return tuple(made)


def _texts(data: object) -> Iterator[str]:
    """Yield all keys and texts of a file, at any nesting depth."""
    left = [data]
    while left:
        each = left.pop()
        if isinstance(each, str):
            yield each
        elif isinstance(each, Mapping):
            yield from each
            left += each.values()
        elif isinstance(each, list):
            left += each
