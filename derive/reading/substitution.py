"""Recognise an equation that introduces an angle for a position, such as x = b sin(phi)."""

from sympy import Expr, Symbol
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from derive.reading.words import FUNCTIONS

_POSITIONS = frozenset(("x", "s", "xi", "t", "r", "y", "z"))


def substitution(left: Expr, right: Expr) -> tuple[Symbol, Expr] | None:
    """Return the angle and its principal value, such as phi and asin(x/b).

    The result is None for any other equation.
    """
    if not isinstance(left, Symbol) or left.name not in _POSITIONS:
        return None
    for function in right.atoms(TrigonometricFunction, HyperbolicFunction):
        angle = function.args[0]
        shift, term = right.as_independent(angle, as_Add=True)
        factor, last = term.as_independent(angle, as_Add=False)
        if isinstance(angle, Symbol) and last == function and not right.has(left):
            inverse = FUNCTIONS[f"a{function.func.__name__}"].of_sympy
            return angle, inverse((left - shift) / factor)
    return None
