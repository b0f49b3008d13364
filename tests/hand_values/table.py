"""Reads hand-worked values from Markdown tables with the columns inputs, expected and working.

A file is named after its body. A level-2 heading that is one word names a function; under it come
the function's signature and any number of tables:

    ## tilt

    `tilt(a, c, *, R) -> alpha`

    | inputs | expected | working |
    | --- | --- | --- |
    | `a=2, c=1, R=1` | `1/2` | (2 − 1)/2 |

Expressions are read by `evaluate`, which knows numbers, elementary functions, and the few others
that closed forms of contacts need: the complete elliptic integrals K and E of the parameter
m = k**2, ellipk(m) and ellipe(m), and the modified Bessel functions I_0 and I_1, besseli0(x) and
besseli1(x).  Nothing else.

Under stick_zone a and c are the edges of a contact that stays the same through the cycle.
"""

import ast
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

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

NON_FINITE = {"nan": mpmath.nan, "inf": mpmath.inf, "-inf": -mpmath.inf}

OPERATORS: Mapping[type[ast.AST], Callable[..., mpmath.mpf]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}

NAMES = (
    *("sqrt", "exp", "log"),
    *("sin", "cos", "tan", "asin", "acos", "atan"),
    *("sinh", "cosh", "tanh", "asinh", "acosh", "atanh"),
    *("ellipk", "ellipe"),
)
FUNCTIONS: Mapping[str, Callable[[mpmath.mpf], mpmath.mpf]] = {
    **{name: getattr(mpmath, name) for name in NAMES},
    "besseli0": partial(mpmath.besseli, 0),
    "besseli1": partial(mpmath.besseli, 1),
}

_NUMBER = re.compile(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,4})?")
_HEADING = re.compile(r"##? +(?P<title>.+)")
_SIGNATURE = re.compile(r"`(?P<name>\w+)\((?P<parameters>[^()]*)\) -> (?P<fields>\w+(, \w+)*)`")
_RULE = re.compile(r"\|( *:?-+:? *\|){3}")
_BAR = re.compile(r"(?<!\\)\|")

Signature = Mapping[str, mpmath.mpf | None]
"""Parameters with their defaults; None where a value must be given."""


class TableError(ValueError):
    """Something in a table that cannot be read, with its file and line."""


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


def evaluate(text: str) -> mpmath.mpf:
    """Give the value of an expression such as `2*sqrt(3)/pi`, to 40 digits.

    >>> print(mpmath.nstr(evaluate("2*sqrt(3)/pi"), 15))
    1.10265779084358
    """
    text = text.strip()
    if text in NON_FINITE:
        return NON_FINITE[text]
    try:
        tree = ast.parse(text, mode="eval")
        with mpmath.workdps(DIGITS):
            value = _value(tree.body, text)
    except SyntaxError:
        raise ValueError(f"cannot read the expression '{text}'") from None
    except (ArithmeticError, RecursionError):
        raise ValueError(f"cannot evaluate the expression '{text}'") from None
    if not (isinstance(value, mpmath.mpf) and mpmath.isfinite(value)):
        raise ValueError(f"'{text}' is not a finite real number")
    return value


def _value(node: ast.expr, text: str) -> mpmath.mpf:
    match node:
        case ast.Constant():
            return _number(_segment(node, text))
        case ast.Name(id="pi"):
            return +mpmath.pi
        case ast.UnaryOp(op=op, operand=operand) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(operand, text))
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(left, text), _value(right, text))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return FUNCTIONS[name](_value(argument, text))
        case _:
            raise ValueError(f"'{_segment(node, text)}' is not allowed in an expression")


def _number(literal: str) -> mpmath.mpf:
    """Read the decimal as written: 0.1 means one tenth, not the nearest double."""
    if not _NUMBER.fullmatch(literal):
        raise ValueError(f"'{literal}' is not a number")
    return mpmath.mpf(literal)


def _segment(node: ast.expr, text: str) -> str:
    return ast.get_source_segment(text, node) or text


def named_values(text: str) -> dict[str, mpmath.mpf]:
    """Read `a=1, c=sqrt(2)` as names and values."""
    source = f"_({text})"
    try:
        call = ast.parse(source, mode="eval").body
    except SyntaxError:
        call = None
    if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)) or call.args:
        raise ValueError(f"cannot read '{text}': expected name=value, name=value, ...")
    names = [keyword.arg for keyword in call.keywords]
    if None in names or len(set(names)) < len(names):
        raise ValueError(f"cannot read '{text}': expected each name=value once")
    return {str(k.arg): evaluate(_segment(k.value, source)) for k in call.keywords}


def read_table(path: Path) -> list[Row]:
    """Every row of a file, in its order; a TableError names the file and line of what is wrong."""
    rows: list[Row] = []
    function, signature = "", None
    for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1):
        place = f"{path.name}:{number}"
        try:
            if heading := _HEADING.fullmatch(line.strip()):
                function, signature = _function(line, heading["title"]), None
            elif function and line.startswith("`"):
                signature = _signature(line.strip(), function)
            elif _BAR.search(line):
                cells = _cells(line.strip())
                if signature is None:
                    raise ValueError("a table outside a function's section, before its signature")
                if cells != COLUMNS and not _RULE.fullmatch(line.strip()):
                    row = _row(path.stem, function, signature, cells, place)
                    if any(r.inputs == row.inputs for r in rows if r.function == function):
                        raise ValueError(f"repeats a row: {row.text}")
                    rows.append(row)
        except ValueError as error:
            raise TableError(f"{place}: {error}") from error
    return rows


def _function(line: str, title: str) -> str:
    """The function that a heading names; none if it is one of prose."""
    if line.startswith("# ") or not title.isidentifier():
        return ""
    if title not in RESULTS:
        raise ValueError(f"unknown function {title}: expected one of {', '.join(RESULTS)}")
    return title


def _signature(text: str, function: str) -> Signature:
    """Read a line such as `contact(P, M=0, *, E_star, R) -> a, c, alpha`, backticks included."""
    found = _SIGNATURE.fullmatch(text)
    if not found:
        raise ValueError(f"expected a signature such as `tilt(a, c, *, R) -> alpha`, not {text}")
    if found["name"] != function:
        raise ValueError(f"the signature of {found['name']} under {function}")
    if tuple(found["fields"].split(", ")) != RESULTS[function]:
        raise ValueError(f"{function} gives {', '.join(RESULTS[function])}")
    parameters = (p.partition("=") for p in found["parameters"].split(",") if p.strip() != "*")
    return {name.strip(): evaluate(default) if default else None for name, _, default in parameters}


def _cells(line: str) -> list[str]:
    r"""Split a table's line; `\|` stands for a bar, and backticks around a cell are left out."""
    before, *cells, after = _BAR.split(line)
    if before or after or len(cells) != len(COLUMNS):
        raise ValueError(f"a row is | {' | '.join(COLUMNS)} |")
    return [cell.replace(r"\|", "|").strip().removeprefix("`").removesuffix("`") for cell in cells]


def _row(body: str, function: str, signature: Signature, cells: list[str], place: str) -> Row:
    text, expected, working = cells
    if not working:
        raise ValueError("the working is empty: say how a person gets the value")
    given = named_values(text)
    if unknown := given.keys() - signature:
        raise ValueError(f"{function} takes no {', '.join(sorted(unknown))}")
    inputs = {**signature, **given}
    if missing := [name for name, value in inputs.items() if value is None]:
        raise ValueError(f"{function} needs {', '.join(missing)}")
    fields = RESULTS[function]
    values = {fields[0]: evaluate(expected)} if len(fields) == 1 else named_values(expected)
    if tuple(values) != fields:
        raise ValueError(f"expected a value for each of {', '.join(fields)}, in this order")
    return Row(body, function, text, inputs, values, working, place)
