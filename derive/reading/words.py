"""The functions and names that a text may contain; all others are refused.

Each function has one row, in the table below.  To let claims use another one, add its row.
"""

import keyword
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import sympy
from sympy import Expr

from derive.command.errors import BadText

MANY = 20
"""The largest number of arguments of a function."""

Switches = list[tuple[str, Expr]]
"""Expressions at whose zeros a function is not smooth, each with its kind in derive.proof.kinks."""


@dataclass(frozen=True)
class Function:
    """A function that may be called.

    of_sympy     the function in SymPy
    latex        the commands that print it
    switches     where it may not be smooth, for its arguments
    like         its family: functions of one family may have been confused in print
    most, least  the numbers of its arguments
    """

    of_sympy: Callable[..., Any]
    latex: str = ""
    switches: Callable[..., Switches] = lambda *_: []
    like: str = ""
    most: int = 1
    least: int = 1


def _zeros(kind: str, *of: Callable[..., Expr]) -> Callable[..., Switches]:
    """Return the switches of one kind, from expressions of the arguments."""
    return lambda *arguments: [(kind, each(*arguments)) for each in of]


def _kinks_between(*arguments: Expr) -> Switches:
    return [("kink", one - other) for one, other in combinations(arguments, 2)]


def _logarithms_at_one(*arguments: Expr) -> Switches:
    return [("branch", 1 - argument) for argument in arguments]


def _inside(argument: Expr) -> Expr:
    return argument.args[0] if isinstance(argument, sympy.Abs) else argument


_KINK = _zeros("kink", lambda argument, *_: argument)
_AT_ONE = _zeros("branch", lambda argument: argument - 1)
_AT_BOTH = (lambda argument: 1 + argument, lambda argument: 1 - argument)


_OF_PROFILES = {
    "Abs": Function(sympy.Abs, switches=_KINK),
    "sqrt": Function(sympy.sqrt),
    "sign": Function(sympy.sign, r"\sgn", _KINK),
    "Heaviside": Function(sympy.Heaviside, switches=_KINK),
    "Max": Function(sympy.Max, r"\max", _kinks_between, most=MANY),
    "Min": Function(sympy.Min, r"\min", _kinks_between, most=MANY),
    "Piecewise": Function(sympy.Piecewise, most=MANY),
    "exp": Function(sympy.exp, r"\exp"),
    "log": Function(sympy.log, r"\ln \log", _zeros("branch", _inside)),
    "sin": Function(sympy.sin, r"\sin", like="circular"),
    "cos": Function(sympy.cos, r"\cos", like="circular"),
    "tan": Function(sympy.tan, r"\tan \tg", _zeros("branch", sympy.cos), "circular"),
    "asin": Function(sympy.asin, r"\arcsin", _zeros("branch", *_AT_BOTH), "inverse circular"),
    "acos": Function(sympy.acos, r"\arccos", _zeros("branch", *_AT_BOTH), "inverse circular"),
    "atan": Function(sympy.atan, r"\arctan \arctg", like="inverse circular"),
    "sinh": Function(sympy.sinh, r"\sinh", like="hyperbolic"),
    "cosh": Function(sympy.cosh, r"\cosh", like="hyperbolic"),
    "tanh": Function(sympy.tanh, r"\tanh", like="hyperbolic"),
    "asinh": Function(sympy.asinh, r"\arsinh", like="inverse hyperbolic"),
    "acosh": Function(sympy.acosh, r"\arcosh", _AT_ONE, "inverse hyperbolic"),
    "atanh": Function(sympy.atanh, r"\artanh", _zeros("branch", *_AT_BOTH), "inverse hyperbolic"),
}
_OF_CLAIMS = {
    "cot": Function(lambda z: 1 / sympy.tan(z), r"\cot \ctg", like="reciprocal circular"),
    "sec": Function(lambda z: 1 / sympy.cos(z), r"\sec", like="reciprocal circular"),
    "csc": Function(lambda z: 1 / sympy.sin(z), r"\csc \cosec", like="reciprocal circular"),
    "asec": Function(lambda z: sympy.acos(1 / z), r"\arcsec", like="reciprocal circular"),
    "acsc": Function(lambda z: sympy.asin(1 / z), r"\arccsc", like="reciprocal circular"),
    "coth": Function(lambda z: 1 / sympy.tanh(z), r"\coth", like="reciprocal hyperbolic"),
    "sech": Function(lambda z: 1 / sympy.cosh(z), r"\sech", like="reciprocal hyperbolic"),
    "csch": Function(lambda z: 1 / sympy.sinh(z), r"\csch \cosech", like="reciprocal hyperbolic"),
    "acoth": Function(lambda z: sympy.atanh(1 / z), r"\arcoth", like="reciprocal hyperbolic"),
    "asech": Function(lambda z: sympy.acosh(1 / z), r"\arsech", like="reciprocal hyperbolic"),
    "acsch": Function(lambda z: sympy.asinh(1 / z), r"\arcsch", like="reciprocal hyperbolic"),
    "elliptic_k": Function(sympy.elliptic_k, "", _logarithms_at_one, "elliptic"),
    "elliptic_e": Function(sympy.elliptic_e, "", _logarithms_at_one, "elliptic"),
    "elliptic_pi": Function(sympy.elliptic_pi, "", _logarithms_at_one, most=2, least=2),
    "gamma_function": Function(sympy.gamma, r"\Gamma"),
}
"""Further functions of claims; elliptic integrals are those of the parameter m = k**2.

The inverse of the cotangent has two conventions for negative numbers, so it is not among them.
"""
_ALIASES = {name.lower(): _OF_PROFILES[name] for name in ("Abs", "Max", "Min")}

FUNCTIONS_OF_PROFILES = {**_OF_PROFILES, **_ALIASES}
"""The functions that g(x) may contain."""
FUNCTIONS = {**FUNCTIONS_OF_PROFILES, **_OF_CLAIMS}
"""The functions that claims may contain."""
COMMANDS = {
    command: name
    for name, each in {**_OF_PROFILES, **_OF_CLAIMS}.items()
    for command in each.latex.split()
}
"""The function for each command of LaTeX."""

PI, TRUE = "pi", "True"
LOGICAL = {"and": "AND", "or": "OR", "not": "NOT"}
"""The logical operators, with their terminals in text.lark."""

KEYWORDS = frozenset(keyword.kwlist) - {TRUE, *LOGICAL}
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
