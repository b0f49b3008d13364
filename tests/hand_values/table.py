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
from collections.abc import Callable, Iterator, Mapping
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
_SIGNATURE = re.compile(r"`(?P<name>\w+)\((?P<parameters>[^()]*)\) -> (?P<fields>\w+(, \w+)*)`")
_HEADING = re.compile(r"(?P<level>#+) +(?P<title>.+)")
_RULE = re.compile(r"\|( *:?-+:? *\|)+")
_PIPE = re.compile(r"(?<!\\)\|")


class TableError(ValueError):
    """Something in a table that cannot be read, with its file and line."""

    def __init__(self, path: Path, line: int, message: str) -> None:
        super().__init__(f"{path}:{line}: {message}")


@dataclass(frozen=True)
class Signature:
    """A function's parameters with their defaults (None: must be given) and its result's fields."""

    function: str
    parameters: Mapping[str, mpmath.mpf | None]
    fields: tuple[str, ...]


@dataclass(frozen=True)
class Row:
    """One hand-worked value: exact inputs, the expected value of each field, and the working."""

    body: str
    function: str
    text: str
    inputs: Mapping[str, mpmath.mpf] = field(repr=False)
    expected: Mapping[str, mpmath.mpf] = field(repr=False)
    working: str = field(repr=False)
    path: Path = field(repr=False)
    line: int

    def __str__(self) -> str:
        return f"{self.body}-{self.function}({self.text})"

    @property
    def place(self) -> str:
        """Where the row stands, as file:line."""
        return f"{self.path.name}:{self.line}"

    @property
    def arguments(self) -> dict[str, float]:
        """The inputs as doubles, defaults included."""
        return {name: float(value) for name, value in self.inputs.items()}

    @property
    def key(self) -> tuple[object, ...]:
        """What makes the row the same as another: its function and the values of its inputs."""
        values = ((name, mpmath.nstr(value, DIGITS)) for name, value in self.inputs.items())
        return self.function, *sorted(values)


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
        raise ValueError(f"cannot read '{text}': expected name=value, name=value, ...") from None
    if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Name)) or call.args:
        raise ValueError(f"cannot read '{text}': expected name=value, name=value, ...")
    values: dict[str, mpmath.mpf] = {}
    for keyword in call.keywords:
        if keyword.arg is None or keyword.arg in values:
            raise ValueError(f"cannot read '{text}': expected each name=value once")
        values[keyword.arg] = evaluate(_segment(keyword.value, source))
    return values


def read_signature(text: str) -> Signature:
    """Read a line such as `contact(P, M=0, *, E_star, R) -> a, c, alpha`, backticks included."""
    found = _SIGNATURE.fullmatch(text)
    if not found:
        raise ValueError(f"expected a signature such as `tilt(a, c, *, R) -> alpha`, not {text}")
    parameters: dict[str, mpmath.mpf | None] = {}
    for parameter in found["parameters"].split(","):
        name, _, default = (part.strip() for part in parameter.partition("="))
        if name != "*":
            parameters[name] = evaluate(default) if default else None
    return Signature(found["name"], parameters, tuple(found["fields"].split(", ")))


def read_table(path: Path) -> list[Row]:
    """Every row of a file, in its order; a TableError names the file and line of what is wrong."""
    rows: dict[tuple[object, ...], Row] = {}
    for row in _Reader(path).rows():
        if row.key in rows:
            first = rows[row.key].line
            raise TableError(path, row.line, f"repeats the row of line {first}: {row.text}")
        rows[row.key] = row
    return list(rows.values())


class _Reader:
    """Walks a file line by line, keeping the function, its signature and the table it is in."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.function = ""
        self.signature: Signature | None = None
        self.table_lines = 0  # of the present table, read so far

    def rows(self) -> Iterator[Row]:
        for number, line in enumerate(self.path.read_text("utf-8").splitlines(), start=1):
            try:
                row = self._read(line.strip(), number)
            except ValueError as error:
                raise TableError(self.path, number, str(error)) from error
            if row:
                yield row

    def _read(self, line: str, number: int) -> Row | None:
        if heading := _HEADING.fullmatch(line):
            self._enter(heading)
        elif _PIPE.search(line):
            return self._table_line(line, number)
        elif self.function and line.startswith("`"):
            self._sign(line)
        self.table_lines = 0
        return None

    def _enter(self, heading: re.Match[str]) -> None:
        if len(heading["level"]) > 2:
            return
        title = heading["title"].strip()
        self.function, self.signature = "", None
        if heading["level"] == "##" and title.isidentifier():
            if title not in RESULTS:
                raise ValueError(f"unknown function {title}: expected one of {', '.join(RESULTS)}")
            self.function = title

    def _sign(self, line: str) -> None:
        self.signature = read_signature(line)
        if self.signature.function != self.function:
            raise ValueError(f"the signature of {self.signature.function} under {self.function}")
        if self.signature.fields != RESULTS[self.function]:
            raise ValueError(f"{self.function} gives {', '.join(RESULTS[self.function])}")

    def _table_line(self, line: str, number: int) -> Row | None:
        if not self.signature:
            raise ValueError("a table outside a function's section, or before its signature")
        cells = _cells(line)
        self.table_lines += 1
        if self.table_lines == 1:
            if cells != COLUMNS:
                raise ValueError(f"a table starts with | {' | '.join(COLUMNS)} |")
        elif self.table_lines == 2:
            if not _RULE.fullmatch(line) or len(cells) != len(COLUMNS):
                raise ValueError("expected the line | --- | --- | --- | under the table's head")
        else:
            return self._row(cells, self.signature, number)
        return None

    def _row(self, cells: list[str], signature: Signature, number: int) -> Row:
        if len(cells) != len(COLUMNS):
            raise ValueError(f"expected three cells, {', '.join(COLUMNS)}, not {len(cells)}")
        inputs, expected, working = cells
        if not working:
            raise ValueError("the working is empty: say how a person gets the value")
        return Row(
            body=self.path.stem,
            function=self.function,
            text=_code(inputs),
            inputs=_inputs(_code(inputs), signature),
            expected=_expected(_code(expected), signature),
            working=working,
            path=self.path,
            line=number,
        )


def _cells(line: str) -> list[str]:
    r"""Split a table's line; `\|` stands for a bar inside a cell."""
    before, *cells, after = _PIPE.split(line)
    if before or after or not cells:
        raise ValueError("a table's line starts and ends with |")
    return [cell.strip().replace(r"\|", "|") for cell in cells]


def _code(cell: str) -> str:
    """Take the backticks off a cell."""
    inside = cell[1:-1] if cell.startswith("`") and cell.endswith("`") else cell
    return inside.strip()


def _inputs(text: str, signature: Signature) -> dict[str, mpmath.mpf]:
    given = named_values(text)
    if unknown := given.keys() - signature.parameters:
        raise ValueError(f"{signature.function} takes no {', '.join(sorted(unknown))}")
    values = {**signature.parameters, **given}
    if missing := [name for name, value in values.items() if value is None]:
        raise ValueError(f"{signature.function} needs {', '.join(missing)}")
    return values


def _expected(text: str, signature: Signature) -> dict[str, mpmath.mpf]:
    fields = signature.fields
    if len(fields) == 1:
        return {fields[0]: evaluate(text)}
    values = named_values(text)
    if tuple(values) != fields:
        raise ValueError(f"expected a value for each of {', '.join(fields)}, in this order")
    return values
