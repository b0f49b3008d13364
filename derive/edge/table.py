"""Read tables as exported by finite-element programs: separators, headers, units and load steps.

A table has a line of column names above its numbers.  It must have the position along the
interface and the pressure.  It may also have the load step, and the shear traction of a run in
which nothing slips.  Several columns of pressure are several load steps.  Other columns are
ignored.  Units follow the names, with or without brackets, or are in a separate line.
"""

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from derive.command.errors import BadTable
from derive.command.files import Unreadable, bytes_of

LARGEST = 20_000_000
"""The largest size of a file, in bytes."""

_LONGEST_LINE, _LONGEST_NUMBER = 20_000, 50
"""The largest number of characters in a line, below the limit of the module csv for one field, and
in a number."""

MOST_NODES = 20_000
"""The largest number of nodes of a load step."""

SMALLEST, GREATEST = 1e-30, 1e30
"""The range of the magnitudes of numbers other than zero, in SI units: products of several such
numbers can still be computed."""

LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "in": 0.0254}
STRESSES = {
    **{"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "n/m2": 1.0, "n/mm2": 1e6},
    **{"psi": 6894.757293168361, "ksi": 6894757.293168361},
}

NAMES = {
    "x": (
        *("x", "x coordinate", "x location", "coord1", "coor1", "position", "distance", "path"),
        *("true distance", "true distance along path", "x distance", "location", "arc length"),
    ),
    "p": ("p", "pressure", "cpress", "contact pressure", "contpres", "normal traction"),
    "q": (
        *("q", "dq", "shear", "cshear", "cshear1", "shear traction", "shear stress", "contfric"),
        *("frictional stress", "frictional shear", "tangential traction"),
    ),
    "step": ("step", "load step", "loadstep", "time", "frame", "increment", "inc", "substep"),
}
"""The names by which columns are recognised."""

MEANT = {"x": "the position along the interface", "p": "the contact pressure"}

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?nan|[+-]?inf(inity)?", re.I)
_COMMENT = re.compile(r"(#|!|%|//|\*\*)")
_UNIT = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_BEHIND = re.compile(r"(.+?)\s*[_/ ]\s*(\S+)")
"""A name and a unit without brackets, as in x_mm or p / MPa."""

_COUNTED = re.compile(r"(?:(?<=^p)|(?<=^q)|(?<=^dq)|(?<=pressure)|(?<=cpress)| (?:step )?)\d+$")
"""The number of a load step after a name; CSHEAR1 and CSHEAR2 are components instead."""

_SCALES = {"x": LENGTHS, "p": STRESSES, "q": STRESSES}


@dataclass(frozen=True)
class Step:
    """One load step.

    x  positions of the nodes [m]
    p  contact pressure [Pa]
    q  shear traction [Pa], or None if the table has none
    """

    name: str
    x: np.ndarray
    p: np.ndarray
    q: np.ndarray | None


@dataclass(frozen=True)
class _Lines:
    """Rows of fields, each with its line number; comma: whether numbers have decimal commas."""

    rows: tuple[tuple[int, tuple[str, ...]], ...]
    comma: bool


def read(path: Path, units: Mapping[str, str] | None = None) -> tuple[Step, ...]:
    """Read the load steps of a table, in SI units.

    units: the units of x and p if the table does not give them; the shear traction has the unit
    of the pressure.

    Raises BadTable.
    """
    shown = path.name
    lines = _split(_text(path), shown)
    head, data = _parted(lines, shown)
    names, units_found = _header(head, len(data[0][1]), shown)
    columns = _columns(names, shown)
    scale = {
        what: _unit(what, names, columns, units_found, units or {}, shown) for what in ("x", "p")
    }
    place = _numbers(data, columns["x"][0], names, lines.comma, shown, scale["x"])
    labels = _labels(data, columns)
    shear = columns.get("q", [])
    if len(columns["p"]) > 1 and (labels or len(shear) not in (0, 1, len(columns["p"]))):
        raise BadTable(
            shown,
            f"there are {len(columns['p'])} columns of pressure"
            + (" and a column of load steps" if labels else f" and {len(shear)} of shear"),
            "either use one pressure column, and at most one shear column, for each load step, or "
            "name the load steps in a column",
        )
    steps = []
    for number, column in enumerate(columns["p"]):
        p = _numbers(data, column, names, lines.comma, shown, scale["p"])
        q = None
        if shear:
            own = shear[number] if len(shear) == len(columns["p"]) else shear[0]
            q = _numbers(data, own, names, lines.comma, shown, scale["p"])
        for label in dict.fromkeys(labels) if labels else [""]:
            rows = [i for i, of in enumerate(labels) if of == label] if labels else slice(None)
            name = label or (names[column] if len(columns["p"]) > 1 else "")
            x = place[rows]
            if x.size > MOST_NODES:
                raise BadTable(
                    shown,
                    f"a load step has {x.size} nodes, and at most {MOST_NODES} are allowed",
                    "export fewer nodes, for example every second one",
                )
            order = slice(None, None, -1 if np.all(np.diff(x) < 0) else 1)  # from left to right
            shear_here = None if q is None else q[rows][order]
            steps.append(Step(name, x[order], p[rows][order], shear_here))
    return tuple(steps)


def _text(path: Path) -> str:
    """Return the file as text.

    Raises BadTable.
    """
    try:
        raw = bytes_of(path, LARGEST)
    except Unreadable as error:
        raise BadTable(str(path), str(error), "give the path of one table") from error
    coding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = raw.decode(coding)
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    if "\0" in text:
        raise BadTable(path.name, "the file is not text", "export the table as CSV")
    if not text.strip():
        raise BadTable(path.name, "the file is empty", "export nodes and pressures to it")
    return text


def _is_number(field: str, comma: bool) -> bool:
    if len(field) > _LONGEST_NUMBER:
        return False
    return _NUMBER.fullmatch(field.replace(",", ".") if comma else field) is not None


def _split(text: str, shown: str) -> _Lines:
    """Split lines into fields by the separator for which most lines hold only numbers.

    Raises BadTable.
    """
    numbered = list(enumerate(text.splitlines(), 1))
    for number, line in numbered:
        if len(line) > _LONGEST_LINE:
            raise BadTable(
                shown,
                f"line {number} has {len(line)} characters; at most {_LONGEST_LINE} are allowed",
                "export only the columns that are needed",
            )
    lines = [
        (number, line.strip())
        for number, line in numbered
        if line.strip() and not _COMMENT.match(line.strip())
    ]
    best: tuple[tuple[int, int], _Lines] = ((0, 0), _Lines((), False))
    for separator, comma in ((";", False), (";", True), ("\t", False), ("\t", True), (",", False)):
        best = _better(best, lines, separator, comma)
    for comma in (False, True):
        best = _better(best, lines, "", comma)
    if not best[0][1]:
        numbers = sum(_is_number(line, True) for _, line in lines)
        if numbers:
            raise BadTable(
                shown,
                "the table has only one column of numbers",
                "give the positions of the nodes and the pressure there",
            )
        raise BadTable(
            shown, "the table has no rows of numbers", "export nodes and pressures to it"
        )
    return best[1]


def _better(
    best: tuple[tuple[int, int], _Lines],
    lines: Sequence[tuple[int, str]],
    separator: str,
    comma: bool,
) -> tuple[tuple[int, int], _Lines]:
    """Return the better of two ways to split lines.

    The better way gives more rows of at least two fields, all numbers; or, if equal, more rows with
    at least two numbers.
    """
    rows = tuple((number, _fields(line, separator)) for number, line in lines)
    counts = [(sum(_is_number(f, comma) for f in of), len(of)) for _, of in rows]
    score = sum(n == size > 1 for n, size in counts), sum(n > 1 for n, _ in counts)
    return (score, _Lines(rows, comma)) if score > best[0] else best


def _fields(line: str, separator: str) -> tuple[str, ...]:
    if not separator:
        return tuple(line.split())
    (row,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    fields = [field.strip() for field in row]
    while len(fields) > 1 and not fields[-1]:  # some programs end lines with a separator
        fields.pop()
    return tuple(fields)


def _parted(
    lines: _Lines, shown: str
) -> tuple[list[tuple[str, ...]], list[tuple[int, tuple[str, ...]]]]:
    """Return the lines above the numbers, and the rows of numbers.

    Raises BadTable.
    """
    first = next(
        i
        for i, (_, fields) in enumerate(lines.rows)
        if sum(_is_number(field, lines.comma) for field in fields) > 1
    )
    head = [fields for _, fields in lines.rows[:first]]
    data = [row for row in lines.rows[first:] if row[1] not in head]  # drop repeated headers
    width = len(data[0][1])
    for number, fields in data:
        if len(fields) != width:
            raise BadTable(
                shown,
                f"line {number} has {len(fields)} instead of {width} fields",
                "give every line the same number of columns",
            )
    return head, data


def _header(
    head: Sequence[tuple[str, ...]], width: int, shown: str
) -> tuple[list[str], dict[int, str]]:
    """Return the names of the columns, and the units by column.

    Raises BadTable.
    """
    units: dict[int, str] = {}
    rest = list(head)
    if rest and len(rest[-1]) == width and all(map(_is_unit, rest[-1])):
        units = {i: _UNIT.sub(r"\1", field) for i, field in enumerate(rest.pop())}
    if not rest:
        raise BadTable(
            shown,
            "the table has no line with column names",
            "write one above the numbers, such as x [mm], p [MPa]",
        )
    names = _joined(rest[-1], width)
    if len(names) != width:
        commas = " (commas may be decimal commas or separators)"
        raise BadTable(
            shown,
            f"the table has {len(names)} name{'s' * (len(names) > 1)} for {width} columns"
            + (commas if width == 2 * len(names) else ""),
            "give each column a name, and separate columns by ; if numbers have decimal commas",
        )
    for i, name in enumerate(names):
        if found := _UNIT.search(name):
            units.setdefault(i, found.group(1))
        elif behind := _BEHIND.fullmatch(name.strip(' "')):
            bare, unit = behind.groups()
            if _key(unit) in {u for what in _meant(bare) for u in _SCALES.get(what, {})} - {"in"}:
                units.setdefault(i, unit)
                names[i] = bare
    return [_UNIT.sub("", name).strip(' "') for name in names], units


def _joined(fields: tuple[str, ...], width: int) -> list[str]:
    """Join each unit in brackets, if it is a field by itself, to the name before it."""
    names: list[str] = []
    for field in fields:
        if len(fields) > width and names and _UNIT.fullmatch(field):
            names[-1] += f" {field}"
        else:
            names.append(field)
    return names


def _is_unit(field: str) -> bool:
    unit = _key(_UNIT.sub(r"\1", field))
    return unit in ("", "-", "s", "1") or unit in LENGTHS or unit in STRESSES


def _key(unit: str) -> str:
    unit = unit.strip().replace("^", "").replace("²", "2").replace(" ", "")
    return unit if unit in LENGTHS else unit.lower()


def _meant(name: str) -> list[str]:
    """Return the quantities that a column of this name may hold."""
    plain = re.sub(r"[^a-z0-9]+", " ", name.lower()).strip()
    unnumbered = _COUNTED.sub("", plain)
    return [
        what
        for what, accepted in NAMES.items()
        if plain in accepted or (what in "pq" and unnumbered in accepted)
    ]


def _columns(names: Sequence[str], shown: str) -> dict[str, list[int]]:
    """Return the columns of each quantity.

    Raises BadTable.
    """
    columns: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        for what in _meant(name):
            columns.setdefault(what, []).append(i)
    for what in ("x", "p"):
        if what not in columns:
            raise BadTable(
                shown,
                f"no column has {MEANT[what]}; the column names are {', '.join(names)}",
                f"name one of them {what!r}, or {', '.join(NAMES[what][1:5])} or {NAMES[what][5]}",
            )
    for what in ("x", "step"):
        if len(columns.get(what, [])) > 1:
            several = ", ".join(names[i] for i in columns[what])
            raise BadTable(
                shown,
                f"each of the columns {several} may be {what!r}",
                "rename all but one of them",
            )
    doubled = {name for name in names if names.count(name) > 1}
    if doubled & {names[i] for i in columns["p"] + columns.get("q", [])}:
        raise BadTable(
            shown, f"two columns are named {doubled.pop()!r}", "give each column a different name"
        )
    return columns


def _unit(
    what: str,
    names: Sequence[str],
    columns: Mapping[str, Sequence[int]],
    found: Mapping[int, str],
    given: Mapping[str, str],
    shown: str,
) -> float:
    """Return the factor that converts a column to SI units.

    Raises BadTable.
    """
    known, example = (LENGTHS, "mm") if what == "x" else (STRESSES, "MPa")
    of = [*columns[what], *(columns.get("q", []) if what == "p" else [])]
    own = {_key(found[i]): found[i] for i in of if found.get(i)}
    if what in given:
        asked = _key(given[what])
        if asked in known and any(known[key] != known[asked] for key in own.keys() & known.keys()):
            why = (
                f"the table gives {what} in {' and '.join(own.values())}, but --unit says "
                f"{given[what]}"
            )
            raise BadTable(shown, why, "remove --unit, or correct the table")
        own = {asked: given[what]}
    if not own:
        raise BadTable(
            shown,
            f"the unit of {names[of[0]]!r} is missing",
            f"write {names[of[0]]} [{example}] above the column, or add --unit {what}={example}",
        )
    if len(own) > 1:
        raise BadTable(
            shown,
            f"the tractions are given in different units, {' and '.join(own.values())}",
            "use the same unit for all of them",
        )
    ((key, text),) = own.items()
    if key not in known:
        common = ("m", "mm", "um", "in", "Pa", "MPa", "GPa", "N/mm2", "psi", "ksi")
        allowed = ", ".join(unit for unit in common if _key(unit) in known)
        raise BadTable(
            shown, f"{text!r} is not a known unit for {MEANT[what]}", f"write one of {allowed}"
        )
    return known[key]


def _numbers(
    data: Sequence[tuple[int, tuple[str, ...]]],
    column: int,
    names: Sequence[str],
    comma: bool,
    shown: str,
    scale: float,
) -> np.ndarray:
    """Return the numbers of one column in SI units; `scale` is the unit of the column.

    Raises BadTable.
    """
    values = []
    for number, fields in data:
        field = fields[column].replace(",", ".") if comma else fields[column]
        known = _NUMBER.fullmatch(field)
        value = float(re.sub("[dD]", "e", field)) if known and known.group(1) else np.nan
        if not np.isfinite(value):
            what = f"{fields[column]!r}" if fields[column] else "nothing"
            raise BadTable(
                shown,
                f"line {number} has {what} instead of a finite number in column {names[column]!r}",
                "write a number there, or remove the line",
            )
        if value and not SMALLEST <= abs(scale * value) <= GREATEST:
            raise BadTable(
                shown,
                f"line {number} has {fields[column]!r} in column {names[column]!r}, and numbers "
                f"other than 0 must lie between {SMALLEST:g} and {GREATEST:g} in SI units",
                "correct the number or the unit, or write 0 outside the contact",
            )
        values.append(scale * value)
    return np.array(values)


def _labels(
    data: Sequence[tuple[int, tuple[str, ...]]], columns: Mapping[str, Sequence[int]]
) -> list[str]:
    """Return the load step of each row, or an empty list if there is no such column."""
    if "step" not in columns:
        return []
    (column,) = columns["step"]
    return [fields[column] for _, fields in data]
