"""Reads hand-worked values from Markdown tables with the columns inputs, expected and working.

A file is named after its body. A level-2 heading names a function; under it come the function's
signature and any number of tables:

    ## tilt

    `tilt(a, c, *, R) -> alpha`

    | inputs | expected | working |
    | --- | --- | --- |
    | `a=2, c=1, R=1` | `1/2` | (2 − 1)/2 |

Expressions hold numbers, elementary functions, and the few others that closed forms of contacts
need: the complete elliptic integrals K and E of the parameter m = k**2, ellipk(m) and ellipe(m),
and the modified Bessel functions I_0 and I_1, besseli0(x) and besseli1(x).

Under stick_zone a and c are the edges of a contact that stays the same through the cycle.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import mpmath

DIGITS = 40

# What the tables may test, with the fields of each result in their order.
RESULTS: Mapping[str, tuple[str, ...]] = {
    "contact": ("a", "c", "alpha"),
    "contact_at_tilt": ("a", "c", "alpha"),
    "tilt": ("alpha",),
    "load": ("P",),
    "moment": ("M",),
    "pressure": ("p",),
    "K_N": ("left", "right"),
    "L_N": ("left", "right"),
    "K_T": ("left", "right"),
    "L_T": ("left", "right"),
    "stick_margin": ("left", "right"),
    "slip_zones": ("left", "right"),
    "stick_zone": ("m", "n"),
}

COLUMNS = ["inputs", "expected", "working"]

FUNCTIONS = (
    *("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan"),
    *("sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "ellipk", "ellipe"),
)
NAMES: Mapping[str, Any] = {
    **{name: getattr(mpmath, name) for name in FUNCTIONS},
    **{f"besseli{order}": partial(mpmath.besseli, order) for order in (0, 1)},
    **{"pi": mpmath.pi, "nan": mpmath.nan, "inf": mpmath.inf},
    **{"number": mpmath.mpf, "named": dict, "__builtins__": {}},
}

_NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_SIGNATURE = re.compile(r"`(?P<name>\w+)\((?P<parameters>[^()]*)\) -> \w+(, \w+)*`")


@dataclass(frozen=True)
class Row:
    """One hand-worked value: exact inputs, the expected value of each field, and the working."""

    body: str
    function: str
    text: str
    inputs: Mapping[str, mpmath.mpf] = field(repr=False)
    expected: Mapping[str, mpmath.mpf] = field(repr=False)
    working: str = field(repr=False)
    place: str

    def __str__(self) -> str:
        return f"{self.body}-{self.function}({self.text})"

    @property
    def arguments(self) -> dict[str, float]:
        """The inputs as doubles, defaults included."""
        return {name: float(value) for name, value in self.inputs.items()}


def evaluate(text: str) -> Any:
    """Give the value of an expression such as `2*sqrt(3)/pi`, to 40 digits.

    A decimal is read as written: 0.1 means one tenth, not the nearest double.

    >>> print(mpmath.nstr(evaluate("2*sqrt(3)/pi"), 15))
    1.10265779084358
    """
    with mpmath.workdps(DIGITS):
        return eval(_NUMBER.sub(r"number('\g<0>')", text), dict(NAMES))  # noqa: S307


def named_values(text: str) -> dict[str, mpmath.mpf]:
    """Read `a=1, c=sqrt(2)` as names and values."""
    values: dict[str, mpmath.mpf] = evaluate(f"named({text})")
    return values


def read_table(path: Path) -> list[Row]:
    """Every row of a file, in its order; a ValueError names the file and line of what is wrong."""
    rows: list[Row] = []
    function, parameters = "", dict[str, str]()
    for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1):
        if line.startswith("#"):
            function = line.strip("# ")
        elif signature := _SIGNATURE.fullmatch(line):
            if signature["name"] != function:
                raise ValueError(f"{path.name}:{number}: the signature of another function")
            parameters = dict(re.findall(r"(\w+)=?(\w*)", signature["parameters"]))
        elif line.startswith("|"):
            cells = [cell.strip().strip("`") for cell in line.strip("|").split("|")]
            if cells == COLUMNS or not line.strip("|-: "):
                continue
            try:
                rows.append(_row(path.stem, function, parameters, cells, f"{path.name}:{number}"))
            except Exception as error:
                raise ValueError(f"{path.name}:{number}: {error}") from error
    return rows


def _row(
    body: str, function: str, parameters: Mapping[str, str], cells: list[str], place: str
) -> Row:
    """A row of a table; `parameters` have the text of their defaults, or none."""
    if function not in RESULTS or len(cells) != len(COLUMNS) or not all(cells):
        raise ValueError(f"expected | {' | '.join(COLUMNS)} | of one of {', '.join(RESULTS)}")
    text, expected, working = cells
    defaults = {name: evaluate(default) for name, default in parameters.items() if default}
    inputs = defaults | named_values(text)
    if inputs.keys() != parameters.keys():
        raise ValueError(f"{function} takes {', '.join(parameters)}")
    fields = RESULTS[function]
    values = {fields[0]: evaluate(expected)} if len(fields) == 1 else named_values(expected)
    if tuple(values) != fields:
        raise ValueError(f"expected a value for each of {', '.join(fields)}, in this order")
    return Row(body, function, text, inputs, values, working, place)
