"""The functions and names that a text may contain; all others are refused."""

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

    @property
    def number(self) -> str:
        """The number of arguments, in words."""
        if self.most == 1:
            return "one argument"
        if self.most in (self.least, MANY):
            return f"{'at most ' * (self.most == MANY)}{self.most} arguments"
        return f"{self.least} to {self.most}"


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
"""The functions of g(x)."""

PI, TRUE = "pi", "True"
LOGICAL = {"&": "and", "|": "or", "~": "not"}
"""The signs of the logical operators, and the equivalent words."""

KEYWORDS = frozenset(keyword.kwlist) - {TRUE, *LOGICAL.values()}
"""Keywords of Python that are not allowed in a formula."""


@dataclass(frozen=True)
class Words:
    """The names that a text may contain.

    functions  the functions that may be called
    deepest    the largest number of nested parentheses, calls and powers of powers
    mistake    why any other name is refused, and what to do instead; None if it is allowed
    """

    functions: Mapping[str, Function]
    deepest: int
    mistake: Callable[[str], tuple[str, str] | None] = lambda name: None


ALLOWED = (
    "x, names of parameters, numbers, pi, + - * / ** ( ); Abs sqrt sign Max Min Heaviside exp log "
    "sin cos tan sinh cosh tanh and their inverses (asin, ...); "
    "Piecewise((value, condition), ..., (value, True)) with < <= > >= and or not"
)


def refusal(text: str, column: int, why: str, remedy: str) -> BadText:
    """The error for the mistake at `column` of `text`."""
    return BadText(text, column, why, remedy, ALLOWED)
