"""The functions and names that the text of g(x) may contain; all others are refused."""

import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy

from derive.errors import BadText

MANY = 20
"""The largest number of arguments of a function."""


@dataclass(frozen=True)
class Function:
    """A function that may be called: its name in SymPy and its numbers of arguments."""

    name: str
    most: int = 1
    least: int = 1

    @property
    def of_sympy(self) -> Callable[..., Any]:
        """The function in SymPy."""
        return getattr(sympy, self.name)


_OF_ONE = (
    *("Abs", "sqrt", "sign", "Heaviside", "exp", "log", "sin", "cos", "tan", "asin", "acos"),
    *("atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"),
)

FUNCTIONS = {name: Function(name) for name in _OF_ONE} | {
    "abs": Function("Abs"),
    "Max": Function("Max", MANY),
    "max": Function("Max", MANY),
    "Min": Function("Min", MANY),
    "min": Function("Min", MANY),
    "Piecewise": Function("Piecewise", MANY),
}


@dataclass(frozen=True)
class Words:
    """The names that a text may contain.

    functions      the functions that may be called
    of_parameters  whether all other names must be valid names of parameters of a geometry
    deepest        the largest number of nested parentheses, calls and powers of powers
    """

    functions: Mapping[str, Function]
    of_parameters: bool
    deepest: int


OF_PROFILES = Words(FUNCTIONS, of_parameters=True, deepest=30)
"""The names that g(x) may contain."""

PI = "pi"
TRUE = "True"
LOGICAL = {"and": "&", "or": "|", "not": "~"}
"""The logical operators as words, and the equivalent signs."""

KEYWORDS = frozenset(keyword.kwlist) - {TRUE, *LOGICAL}
"""Keywords of Python that are not allowed in a formula."""

OF_THE_FILE = frozenset({"Geometry", "geometry", "parameter", "Rational"})
"""Names that the geometry file itself uses."""

ALLOWED = (
    "x, names of parameters, numbers, pi, + - * / ** ( ); Abs sqrt sign Max Min Heaviside exp log "
    "sin cos tan sinh cosh tanh and their inverses (asin, ...); "
    "Piecewise((value, condition), ..., (value, True)) with < <= > >= and or not"
)


def refusal(text: str, column: int, why: str, remedy: str) -> BadText:
    """The error for the mistake at `column` of `text`."""
    return BadText(text, column, why, remedy, ALLOWED)
