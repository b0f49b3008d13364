"""What a text of g(x) may hold; everything else is refused."""

import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy

from derive.errors import BadText

MANY = 20
"""The most arguments that any function takes."""


@dataclass(frozen=True)
class Function:
    """A function that may be called: its name in SymPy and how many arguments it takes."""

    name: str
    most: int = 1
    least: int = 1

    @property
    def of_sympy(self) -> Callable[..., Any]:
        """What it stands for."""
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
    """What the names of a text may be.

    functions      what may be called
    of_parameters  whether any other name must be fit for a parameter of a geometry
    deepest        levels of parentheses, calls and powers of powers
    """

    functions: Mapping[str, Function]
    of_parameters: bool
    deepest: int


OF_PROFILES = Words(FUNCTIONS, of_parameters=True, deepest=30)
"""The words of g(x)."""

PI = "pi"
TRUE = "True"
LOGICAL = {"and": "&", "or": "|", "not": "~"}
"""Words for a condition, and the signs that mean the same."""

KEYWORDS = frozenset(keyword.kwlist) - {TRUE, *LOGICAL}
"""Words of Python that are no part of a formula."""

OF_THE_FILE = frozenset({"Geometry", "geometry", "parameter", "Rational"})
"""Names that a geometry file uses itself."""

ALLOWED = (
    "x, names of parameters, numbers, pi, + - * / ** ( ); Abs sqrt sign Max Min Heaviside exp log, "
    "sin cos tan sinh cosh tanh and their inverses asin ...; "
    "Piecewise((value, condition), ..., (value, True)) with < <= > >= and or not"
)


def refusal(text: str, column: int, why: str, remedy: str) -> BadText:
    """The error for what stands at `column` of `text`."""
    return BadText(text, column, why, remedy, ALLOWED)
