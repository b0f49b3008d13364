"""Read tables as exported by finite-element programs: separators, headers, units and load steps.

A table has a line of column names above its numbers, which also says how columns are separated.  It
must have the position along the interface and the pressure.  It may also have the load step, and
the shear traction of a run in which nothing slips.  Several columns of pressure are several load
steps.  Other columns are ignored.  Units follow the names, with or without brackets.
"""

import csv
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from derive.command.errors import BadTable
from derive.command.files import Unreadable, bytes_of

MAX_BYTES = 20_000_000
"""The largest size of a file."""

MAX_LINE, MAX_LABEL = 20_000, 100
"""The largest numbers of characters in a line, below the limit of the module csv for one field, and
in the name of a load step."""

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

_SEPARATORS = (";", "\t", ",", " ")
"""Separators of columns; with all but the comma, numbers may have decimal commas."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")
_COMMENT = re.compile(r"(#|!|%|//|\*\*)")
_UNIT = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_BEHIND = re.compile(r"(.+?)\s*[_/ ]\s*(\S+)")
"""A name and a unit without brackets, as in x_mm or p / MPa."""

_COUNTED = re.compile(r"(?:(?<=^p)|(?<=^q)|(?<=^dq)|(?<=pressure)|(?<=cpress)| (?:step )?)\d+$")
"""The number of a load step after a name; CSHEAR1 and CSHEAR2 are components instead."""

_SCALES = {"x": LENGTHS, "p": STRESSES, "q": STRESSES}

Fields = tuple[str, ...]
Lines = list[tuple[int, str]]


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
    """The rows of a file, each with its line number, and the names of its columns."""

    def __init__(self, path: Path) -> None:
        self.shown = path.name
        head, self.separator, rest = self._head(self._lines(path))
        self.names, self.units = zip(*map(_split_unit, head), strict=True)
        rows = [(number, _fields(line, self.separator)) for number, line in rest]
        self.rows = [row for row in rows if row[1] != head]  # drop repeated headers
        for number, fields in self.rows:
            if len(fields) != len(head):
                raise self._bad(
                    f"line {number} has {len(fields)} instead of {len(head)} fields",
                    "give each column a name, and separate columns by ; if numbers have decimal "
                    "commas",
                )
        if not self.rows:
            raise self._bad("the table has no rows of numbers", "export nodes and pressures to it")
        self.columns = self._columns()

    def _bad(self, why: str, remedy: str) -> BadTable:
        """The error; a long cell or a long list of names is not repeated in full."""
        shortened = why if len(why) < 400 else f"{why[:200]} ... {why[-150:]}"
        return BadTable(self.shown, shortened, remedy)

    # ------------------------------------------------------------------ rows

    def _lines(self, path: Path) -> Lines:
        """The lines of the file with their numbers, without comments."""
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
        lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1)]
        lines = [(number, line) for number, line in lines if line and not _COMMENT.match(line)]
        for number, line in lines:
            if len(line) > MAX_LINE:
                raise self._bad(
                    f"line {number} has {len(line)} characters; at most {MAX_LINE} are allowed",
                    "export only the columns that are needed",
                )
        return lines

    def _head(self, lines: Lines) -> tuple[Fields, str, Lines]:
        """The names of the columns, the separator that shows them, and the lines below them."""
        for i, (_, line) in enumerate(lines):
            for separator in _SEPARATORS:
                names = _fields(line, separator)
                found = {what for name in names for what in _meant(_split_unit(name)[0])}
                if {"x", "p"} <= found:
                    return names, separator, lines[i + 1 :]
        accepted = (f"{what} ({', '.join(NAMES[what][1:6])}, ...)" for what in MEANT)
        raise self._bad(
            f"no line names a column of {' and one of '.join(MEANT.values())}",
            "write one above the numbers, such as x [mm], p [MPa]; names are "
            + " and ".join(accepted),
        )

    # ------------------------------------------------------------------ columns

    def _columns(self) -> dict[str, list[int]]:
        """The columns of each quantity."""
        columns: dict[str, list[int]] = {"q": [], "step": []}
        for i, name in enumerate(self.names):
            for what in _meant(name):
                columns.setdefault(what, []).append(i)
        for what in ("x", "step"):
            if len(columns[what]) > 1:
                several = ", ".join(self.names[i] for i in columns[what])
                raise self._bad(
                    f"each of the columns {several} may be {what!r}", "rename all but one of them"
                )
        tractions = [self.names[i] for i in columns["p"] + columns["q"]]
        for name in tractions:
            if tractions.count(name) > 1:
                raise self._bad(
                    f"two columns are named {name!r}", "give each column a different name"
                )
        return columns

    def _scale(self, what: str, given: Mapping[str, str]) -> float:
        """The factor that converts a quantity to SI units; the shear has the unit of p."""
        known, example = (LENGTHS, "mm") if what == "x" else (STRESSES, "MPa")
        columns = [*self.columns[what], *(self.columns["q"] if what == "p" else [])]
        texts = [self.units[i] for i in columns if self.units[i]]
        if what in given:  # in place of a unit that is not known, and beside one that is
            texts = [*(text for text in texts if _key(text) in known), given[what]]
        name = self.names[columns[0]]
        if not texts:
            raise self._bad(
                f"the unit of {name!r} is missing",
                f"write {name} [{example}] above the column, or add --unit {what}={example}",
            )
        for text in texts:
            if _key(text) not in known:
                common = ("m", "mm", "um", "in", "Pa", "MPa", "GPa", "N/mm2", "psi", "ksi")
                allowed = ", ".join(unit for unit in common if _key(unit) in known)
                raise self._bad(
                    f"{text!r} is not a known unit for {MEANT[what]}", f"write one of {allowed}"
                )
        if len({known[_key(text)] for text in texts}) > 1:
            raise self._bad(
                f"{name!r} is given in different units, {' and '.join(dict.fromkeys(texts))}",
                "use one unit for all tractions, in the table and in --unit",
            )
        return known[_key(texts[0])]

    def _numbers(self, column: int, scale: float) -> np.ndarray:
        """The numbers of one column in SI units; `scale` is the unit of the column."""
        values, name = [], self.names[column]
        for number, fields in self.rows:
            field = fields[column]
            point = field if self.separator == "," else field.replace(",", ".")
            value = float(re.sub("[dD]", "e", point)) if _NUMBER.fullmatch(point) else np.nan
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


def _fields(line: str, separator: str) -> Fields:
    """The fields of a line; some programs end lines with a separator."""
    if separator == " ":
        return tuple(re.split(r"\s+(?![\[(])", line))  # a unit in brackets belongs to its name
    (row,) = csv.reader([line.rstrip(separator)], delimiter=separator, skipinitialspace=True)
    return tuple(field.strip() for field in row)


def _split_unit(name: str) -> tuple[str, str]:
    """A name and its unit, in brackets or as in x_mm and p / MPa; "" for none."""
    name = name.strip(' "')
    if found := _UNIT.search(name):
        return _UNIT.sub("", name).strip(), found.group(1)
    if behind := _BEHIND.fullmatch(name):
        stem, unit = behind.groups()
        known = {u for what in _meant(stem) for u in _SCALES.get(what, {})} - {"in"}
        if _key(unit) in known:
            return stem, unit
    return name, ""


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
