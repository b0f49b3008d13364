"""Read tables as exported by finite-element programs: separators, headers, units and load steps.

A table has a line of column names above its numbers.  It must have the position along the
interface and the pressure.  It may also have the load step, and the shear traction of a run in
which nothing slips.  Several columns of pressure are several load steps.  Other columns are
ignored.  Units follow the names, with or without brackets, or are in a separate line.
"""

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from derive.command.errors import BadTable
from derive.command.files import Unreadable, bytes_of

MAX_BYTES = 20_000_000
"""The largest size of a file."""

MAX_LINE, MAX_NUMBER, MAX_LABEL = 20_000, 50, 100
"""The largest numbers of characters in a line, below the limit of the module csv for one field, in
a number, and in the name of a load step."""

MAX_NODES, MAX_STEPS = 20_000, 1_000
"""The largest numbers of nodes of a load step, and of load steps."""

SMALLEST, GREATEST = 1e-30, 1e30
"""The range of the magnitudes of numbers other than zero, in SI units: products of several such
numbers can still be computed."""

LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "in": 0.0254}
STRESSES = {
    **{"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "n/m2": 1.0, "n/mm2": 1e6},
    **{"psi": 6894.757293168361, "ksi": 6894.757293168361},
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

_DIALECTS = (
    *((";", False), (";", True), ("\t", False), ("\t", True), (",", False)),
    *((" ", False), (" ", True)),
)
"""Separators, and whether numbers have decimal commas."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?nan|[+-]?inf(inity)?", re.I)
_COMMENT = re.compile(r"(#|!|%|//|\*\*)")
_UNIT = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_BEHIND = re.compile(r"(.+?)\s*[_/ ]\s*(\S+)")
"""A name and a unit without brackets, as in x_mm or p / MPa."""

_COUNTED = re.compile(r"(?:(?<=^p)|(?<=^q)|(?<=^dq)|(?<=pressure)|(?<=cpress)| (?:step )?)\d+$")
"""The number of a load step after a name; CSHEAR1 and CSHEAR2 are components instead."""

_SCALES = {"x": LENGTHS, "p": STRESSES, "q": STRESSES}

Fields = tuple[str, ...]


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


def read(path: Path, units: Mapping[str, str] | None = None) -> tuple[Step, ...]:
    """Read the load steps of a table, in SI units.

    units: the units of x and p if the table does not give them; the shear traction has the unit
    of the pressure.

    Raises BadTable.
    """
    return _Table(path).steps(units or {})


class _Table:
    """The rows of numbers of a file, each with its line number, and the names of its columns."""

    def __init__(self, path: Path) -> None:
        self.shown = path.name
        rows = self._split(self._text(path))
        first = next(i for i, (_, fields) in enumerate(rows) if sum(map(_is_number, fields)) > 1)
        head = [fields for _, fields in rows[:first]]
        self.rows = [row for row in rows[first:] if row[1] not in head]  # drop repeated headers
        width = len(self.rows[0][1])
        for number, fields in self.rows:
            if len(fields) != width:
                raise self._bad(
                    f"line {number} has {len(fields)} instead of {width} fields",
                    "give every line the same number of columns",
                )
        self.names, self.units = self._header(head, width)
        self.columns = self._columns()

    def _bad(self, why: str, remedy: str) -> BadTable:
        """The error; a long cell or a long list of names is not repeated in full."""
        shortened = why if len(why) < 400 else f"{why[:200]} ... {why[-150:]}"
        return BadTable(self.shown, shortened, remedy)

    # ------------------------------------------------------------------ rows

    def _text(self, path: Path) -> str:
        """The file as text."""
        try:
            raw = bytes_of(path, MAX_BYTES)
        except Unreadable as error:
            raise BadTable(str(path), str(error), "give the path of one table") from error
        coding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
        try:
            text = raw.decode(coding)
        except UnicodeDecodeError:
            text = raw.decode("latin-1")
        if "\0" in text:
            raise self._bad("the file is not text", "export the table as CSV")
        if not text.strip():
            raise self._bad("the file is empty", "export nodes and pressures to it")
        return text

    def _split(self, text: str) -> list[tuple[int, Fields]]:
        """The fields of each line, split in the way by which most lines hold only numbers.

        If several ways are equal in this, the one that gives most lines with at least two numbers.
        """
        lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1)]
        lines = [(number, line) for number, line in lines if line and not _COMMENT.match(line)]
        for number, line in lines:
            if len(line) > MAX_LINE:
                raise self._bad(
                    f"line {number} has {len(line)} characters; at most {MAX_LINE} are allowed",
                    "export only the columns that are needed",
                )
        ways = [[(n, _fields(line, *way)) for n, line in lines] for way in _DIALECTS]
        best = max(ways, key=_score)
        if _score(best)[1]:
            return best
        if any(
            _is_number(field) for _, fields in ways[-1] for field in fields[:1] if not fields[1:]
        ):
            raise self._bad(
                "the table has only one column of numbers",
                "give the positions of the nodes and the pressure there",
            )
        raise self._bad("the table has no rows of numbers", "export nodes and pressures to it")

    # ------------------------------------------------------------------ columns

    def _header(self, head: list[Fields], width: int) -> tuple[list[str], dict[int, str]]:
        """The names of the columns, and the units by column."""
        units: dict[int, str] = {}
        if head and len(head[-1]) == width and all(map(_is_unit, head[-1])):
            units = {i: _UNIT.sub(r"\1", field) for i, field in enumerate(head.pop())}
        if not head:
            raise self._bad(
                "the table has no line with column names",
                "write one above the numbers, such as x [mm], p [MPa]",
            )
        names = _joined(head[-1], width)
        if len(names) != width:
            commas = " (commas may be decimal commas or separators)"
            raise self._bad(
                f"the table has {len(names)} name{'s' * (len(names) > 1)} for {width} columns"
                + (commas if width == 2 * len(names) else ""),
                "give each column a name, and separate columns by ; if numbers have decimal commas",
            )
        for i, name in enumerate(names):
            if found := _UNIT.search(name):
                units.setdefault(i, found.group(1))
            elif behind := _BEHIND.fullmatch(name.strip(' "')):
                stem, unit = behind.groups()
                known = {u for what in _meant(stem) for u in _SCALES.get(what, {})} - {"in"}
                if _key(unit) in known:
                    units.setdefault(i, unit)
                    names[i] = stem
        return [_UNIT.sub("", name).strip(' "') for name in names], units

    def _columns(self) -> dict[str, list[int]]:
        """The columns of each quantity."""
        columns: dict[str, list[int]] = {"q": [], "step": []}
        for i, name in enumerate(self.names):
            for what in _meant(name):
                columns.setdefault(what, []).append(i)
        for what in ("x", "p"):
            if what not in columns:
                accepted = f"{', '.join(NAMES[what][1:5])} or {NAMES[what][5]}"
                raise self._bad(
                    f"no column has {MEANT[what]}; the column names are {', '.join(self.names)}",
                    f"name one of them {what!r}, or {accepted}",
                )
        for what in ("x", "step"):
            if len(columns[what]) > 1:
                several = ", ".join(self.names[i] for i in columns[what])
                raise self._bad(
                    f"each of the columns {several} may be {what!r}", "rename all but one of them"
                )
        tractions = [self.names[i] for i in columns["p"] + columns["q"]]
        for name in tractions:
            if self.names.count(name) > 1:
                raise self._bad(
                    f"two columns are named {name!r}", "give each column a different name"
                )
        return columns

    def _scale(self, what: str, given: Mapping[str, str]) -> float:
        """The factor that converts a quantity to SI units; the shear has the unit of p."""
        known, example = (LENGTHS, "mm") if what == "x" else (STRESSES, "MPa")
        columns = [*self.columns[what], *(self.columns["q"] if what == "p" else [])]
        own = {_key(unit): unit for i in columns if (unit := self.units.get(i))}
        if what in given:
            asked = _key(given[what])
            if asked in known and any(known[asked] != known.get(key, known[asked]) for key in own):
                raise self._bad(
                    f"the table gives {what} in {' and '.join(own.values())}, but --unit says "
                    f"{given[what]}",
                    "remove --unit, or correct the table",
                )
            own = {asked: given[what]}
        if not own:
            name = self.names[columns[0]]
            raise self._bad(
                f"the unit of {name!r} is missing",
                f"write {name} [{example}] above the column, or add --unit {what}={example}",
            )
        if len(own) > 1:
            raise self._bad(
                f"the tractions are given in different units, {' and '.join(own.values())}",
                "use the same unit for all of them",
            )
        ((key, text),) = own.items()
        if key not in known:
            common = ("m", "mm", "um", "in", "Pa", "MPa", "GPa", "N/mm2", "psi", "ksi")
            allowed = ", ".join(unit for unit in common if _key(unit) in known)
            raise self._bad(
                f"{text!r} is not a known unit for {MEANT[what]}", f"write one of {allowed}"
            )
        return known[key]

    def _numbers(self, column: int, scale: float) -> np.ndarray:
        """The numbers of one column in SI units; `scale` is the unit of the column."""
        values, name = [], self.names[column]
        for number, fields in self.rows:
            field = fields[column]
            value = float(re.sub("[dD]", "e", field)) if _is_finite(field) else np.nan
            if not np.isfinite(value):
                what = f"{field!r}" if field else "nothing"
                raise self._bad(
                    f"line {number} has {what} instead of a finite number in column {name!r}",
                    "write a number there, or remove the line",
                )
            if value and not SMALLEST <= abs(scale * value) <= GREATEST:
                raise self._bad(
                    f"line {number} has {field!r} in column {name!r}, and numbers other than 0 "
                    f"must lie between {SMALLEST:g} and {GREATEST:g} in SI units",
                    "correct the number or the unit, or write 0 outside the contact",
                )
            values.append(scale * value)
        return np.array(values)

    # ------------------------------------------------------------------ load steps

    def steps(self, units: Mapping[str, str]) -> tuple[Step, ...]:
        """All load steps: by a column of pressure each, or by the labels in a column."""
        scale = {what: self._scale(what, units) for what in ("x", "p")}
        pressures, shears = self.columns["p"], self.columns["q"]
        x = self._numbers(self.columns["x"][0], scale["x"])
        labels = np.array([fields[i] for i in self.columns["step"] for _, fields in self.rows])
        if len(pressures) > 1 and (labels.size or len(shears) not in (0, 1, len(pressures))):
            raise self._bad(
                f"there are {len(pressures)} columns of pressure"
                + (
                    " and a column of load steps" if labels.size else f" and {len(shears)} of shear"
                ),
                "either use one pressure column, and at most one shear column, for each load step, "
                "or name the load steps in a column",
            )
        self._demand_few([self.names[i] for i in pressures] if len(pressures) > 1 else labels)
        made = []
        for number, column in enumerate(pressures):
            p, q = self._numbers(column, scale["p"]), None
            if shears:
                own = shears[number if len(shears) == len(pressures) else 0]
                q = self._numbers(own, scale["p"])
            name = self.names[column] if len(pressures) > 1 else ""
            for label in dict.fromkeys(labels) or [name]:
                rows = labels == label if labels.size else np.full(x.size, True)
                made.append(
                    self._step(str(label), x[rows], p[rows], None if q is None else q[rows])
                )
        return tuple(made)

    def _demand_few(self, names: Iterable[str]) -> None:
        different = {*map(str, names)}
        if len(different) > MAX_STEPS:
            raise self._bad(
                f"the table has {len(different)} load steps, and at most {MAX_STEPS} are allowed",
                "export fewer of them; only the first and the last decide on the slip zones",
            )
        longest = max(map(len, different), default=0)
        if longest > MAX_LABEL:
            raise self._bad(
                f"the name of a load step has {longest} characters, and at most {MAX_LABEL} are "
                "allowed",
                "number the load steps",
            )

    def _step(self, name: str, x: np.ndarray, p: np.ndarray, q: np.ndarray | None) -> Step:
        """One load step, its nodes from left to right."""
        if x.size > MAX_NODES:
            raise self._bad(
                f"a load step has {x.size} nodes, and at most {MAX_NODES} are allowed",
                "export fewer nodes, for example every second one",
            )
        order = slice(None, None, -1 if np.all(np.diff(x) < 0) else 1)
        return Step(name, x[order], p[order], None if q is None else q[order])


def _fields(line: str, separator: str, comma: bool) -> Fields:
    """The fields of a line; decimal commas become points."""
    (row,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    fields = line.split() if separator == " " else [field.strip() for field in row]
    while len(fields) > 1 and not fields[-1]:  # some programs end lines with a separator
        fields.pop()
    points = [field.replace(",", ".") if comma else field for field in fields]
    return tuple(p if _is_number(p) else f for f, p in zip(fields, points, strict=True))


def _is_number(field: str) -> bool:
    return len(field) <= MAX_NUMBER and _NUMBER.fullmatch(field) is not None


def _is_finite(field: str) -> bool:
    known = _NUMBER.fullmatch(field)
    return known is not None and known.group(1) is not None


def _score(rows: Sequence[tuple[int, Fields]]) -> tuple[int, int]:
    """The numbers of rows that hold only numbers, and of rows with at least two of them."""
    counts = [(sum(map(_is_number, fields)), len(fields)) for _, fields in rows]
    return sum(n == size > 1 for n, size in counts), sum(n > 1 for n, _ in counts)


def _joined(fields: Fields, width: int) -> list[str]:
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
    """The quantities that a column of this name may hold."""
    words = re.sub(r"[^a-z0-9]+", " ", name.lower()).strip()
    unnumbered = _COUNTED.sub("", words)
    return [
        what
        for what, accepted in NAMES.items()
        if words in accepted or (what in "pq" and unnumbered in accepted)
    ]
