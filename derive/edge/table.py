"""Read the load steps of a table in the format that docs/edge.md describes.

The table is UTF-8 text: one line of column names with units in brackets, above rows of numbers.
The first of tab, semicolon and comma that is in the line of names separates the columns.  Numbers
may have decimal commas unless commas separate the columns.  Blank lines and lines that begin with #
are skipped, and columns with other names are ignored.
"""

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

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
    **{"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/m2": 1.0, "N/mm2": 1e6},
    **{"N/m^2": 1.0, "N/mm^2": 1e6, "psi": 6894.757293168361, "ksi": 6894757.293168361},
}

NAMES = {
    "x": ("x", "position", "coord1"),
    "p": ("p", "pressure", "cpress", "contpres"),
    "q": ("q", "dq", "shear", "cshear1", "contfric"),
    "step": ("step",),
}
"""The names by which columns are recognised, in lower or upper case."""

FORMAT = (
    "write one line of names such as x [mm]; p [MPa]; q [MPa] above the numbers, in UTF-8, "
    "separate columns by semicolons, tabs or, if numbers have decimal points, commas, and number "
    "load steps in a column step"
)
"""The remedy for a table in another format."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_TITLE = re.compile(r"(?P<name>[^\[\]]*?)\s*(\[\s*(?P<unit>[^\[\]]*?)\s*\])?")


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


class _Column(NamedTuple):
    """A column that is used: its place in a row, its name and its unit, "" for none."""

    place: int
    name: str
    unit: str


def read(path: Path, units: Mapping[str, str] | None = None) -> tuple[Step, ...]:
    """Read the load steps of a table, in SI units.

    units: the units of x and p if the table does not give them; a shear traction without a unit has
    that of the pressure.

    Raises BadTable.
    """
    return _Table(path, units or {}).steps()


class _Table:
    """The rows of a file, each with its line number, and the columns that are used."""

    def __init__(self, path: Path, units: Mapping[str, str]) -> None:
        self.shown, self.units = path.name, units
        lines = self._lines(path)
        if len(lines) < 2:
            raise self._bad("the table has no rows of numbers", FORMAT)
        self.separator = next((mark for mark in "\t;" if mark in lines[0][1]), ",")
        (_, head), *self.rows = ((number, self._fields(line)) for number, line in lines)
        self.columns = self._columns(head)
        for number, row in self.rows:
            if len(row) != len(head):
                raise self._bad(
                    f"line {number} has {len(row)} instead of {len(head)} fields", FORMAT
                )

    def _bad(self, why: str, remedy: str) -> BadTable:
        return BadTable(self.shown, why, remedy)

    def _lines(self, path: Path) -> list[tuple[int, str]]:
        """The lines of the file with their numbers, without comments."""
        try:
            text = bytes_of(path, MAX_BYTES).decode("utf-8-sig")
        except Unreadable as error:
            raise BadTable(str(path), str(error), "give the path of one table") from error
        except UnicodeDecodeError as error:
            raise self._bad("the file is not text in UTF-8", FORMAT) from error
        numbered = enumerate(text.splitlines(), 1)
        lines = [(n, line) for n, line in numbered if line.strip() and line.lstrip()[0] != "#"]
        for number, line in lines:
            if len(line) > MAX_LINE:
                raise self._bad(
                    f"line {number} has {len(line)} characters; at most {MAX_LINE} are allowed",
                    "export only the columns that are needed",
                )
        return lines

    def _fields(self, line: str) -> list[str]:
        row = next(csv.reader([line], delimiter=self.separator, skipinitialspace=True))
        return [field.strip() for field in row]

    def _columns(self, head: list[str]) -> dict[str, _Column]:
        """The column of each quantity."""
        columns: dict[str, _Column] = {}
        for place, title in enumerate(head):
            found = _TITLE.fullmatch(title)
            name, unit = found.group("name", "unit") if found else (title, None)
            for what in (what for what, names in NAMES.items() if name.lower() in names):
                if what in columns:
                    raise self._bad(
                        f"both of the columns {columns[what].name!r} and {name!r} are {what}",
                        "keep one of them, and number load steps in a column step",
                    )
                columns[what] = _Column(place, name, unit or "")
        for what in ("x", "p"):
            if what not in columns:
                raise self._bad(
                    f"no column is named {', '.join(NAMES[what])}; the first line is "
                    f"{self.separator.join(head)!r:.100}",
                    FORMAT,
                )
        return columns

    def _scale(self, what: str) -> float:
        """The factor that converts a quantity to SI units."""
        known, example = (LENGTHS, "mm") if what == "x" else (STRESSES, "MPa")
        _, name, unit = self.columns[what]
        given = self.units.get(what, "")
        if unit and given and unit != given:
            raise self._bad(
                f"{name!r} is given in different units, {unit:.20} and {given:.20}",
                "use one unit in the table and in --unit",
            )
        if what == "q" and not unit:
            return self._scale("p")
        if not (unit or given):
            raise self._bad(
                f"the unit of {name!r} is missing",
                f"write {name} [{example}] above the column, or add --unit {what}={example}",
            )
        if (unit or given) not in known:
            raise self._bad(
                f"{unit or given!r:.60} is not a known unit of {name!r}",
                f"write one of {', '.join(known)}",
            )
        return known[unit or given]

    def _numbers(self, what: str) -> np.ndarray:
        """The numbers of one column in SI units."""
        values, scale = [], self._scale(what)
        place, name, _ = self.columns[what]
        for number, row in self.rows:
            field = row[place] if self.separator == "," else row[place].replace(",", ".")
            value = scale * float(field) if _NUMBER.fullmatch(field) else np.nan
            if not (value == 0 or SMALLEST <= abs(value) <= GREATEST):
                raise self._bad(
                    f"line {number} has {row[place]!r:.60} in column {name!r} instead of 0 or a "
                    f"finite number between {SMALLEST:g} and {GREATEST:g} in SI units",
                    "write a number there, or remove the line",
                )
            values.append(value)
        return np.array(values)

    def steps(self) -> tuple[Step, ...]:
        """All load steps, told apart by the column `step` if there is one."""
        x, p = self._numbers("x"), self._numbers("p")
        q = self._numbers("q") if "q" in self.columns else None
        at = self.columns["step"].place if "step" in self.columns else None
        labels = ["" if at is None else row[at] for _, row in self.rows]
        names = tuple(dict.fromkeys(labels))
        longest = max(map(len, names))
        if len(names) > MAX_STEPS or longest > MAX_LABEL:
            raise self._bad(
                f"the table has {len(names)} load steps, with names of up to {longest} characters, "
                f"and at most {MAX_STEPS} with {MAX_LABEL} characters are allowed",
                "number the load steps and export fewer; the first and the last decide",
            )
        made, of_row = [], np.array(labels)
        for name in names:
            rows = np.flatnonzero(of_row == name)
            if rows.size > MAX_NODES:
                raise self._bad(
                    f"a load step has {rows.size} nodes, and at most {MAX_NODES} are allowed",
                    "export fewer nodes, for example every second one",
                )
            if np.all(np.diff(x[rows]) < 0):
                rows = rows[::-1]  # from left to right
            made.append(Step(name, x[rows], p[rows], None if q is None else q[rows]))
        return tuple(made)
