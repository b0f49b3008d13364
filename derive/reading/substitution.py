"""Recognise an equation that introduces an angle, such as sin(phi) = x/b or x = b sin(phi)."""

from sympy import Expr, Symbol
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from derive.reading.words import FUNCTIONS

_POSITIONS = frozenset(("x", "s", "xi", "t", "r", "y", "z"))


def substitution(left: Expr, right: Expr) -> tuple[Symbol, Expr] | None:
    """Return the angle and its principal value, such as phi and asin(x/b).

    The result is None for any other equation.
    """
    is_turned = isinstance(left, Symbol)
    if is_turned:
        left, right = right, left
    is_position = isinstance(right, Symbol) and right.name in _POSITIONS and not left.has(right)
    for function in left.atoms(TrigonometricFunction, HyperbolicFunction):
        angle, inverse = function.args[0], FUNCTIONS.get(f"a{function.func.__name__}")
        shift, term = left.as_independent(angle, as_Add=True)
        factor, last = term.as_independent(angle, as_Add=False)
        is_alone = isinstance(angle, Symbol) and last == function and not right.has(angle)
        if inverse and is_alone and (is_position or (left == function and not is_turned)):
            return angle, inverse.of_sympy((right - shift) / factor)
    return None
