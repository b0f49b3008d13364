"""Simplification of expressions that contain functions of very different steepness.

In:  an expression, and an operation such as `factor` or `simplify`.
Out: the result; exp(99999 x/b) is not treated as a polynomial of that degree in exp(x/b).
"""

from collections.abc import Callable
from math import lcm

from sympy import Dummy, Expr, Function, Pow, Rational, powsimp

_MAX_DEGREE = 50
"""Largest degree at which functions and powers are treated as polynomials in the smallest one."""


def gently(compute: Callable[[Expr], Expr], expr: Expr) -> Expr:
    """Return compute(expr); steep functions and powers are temporarily replaced by symbols."""
    nodes = [node for node in expr.atoms(Function, Pow) if _is_transcendental(node)]
    if _degree(nodes) <= _MAX_DEGREE:
        return compute(expr)
    combined = powsimp(expr, combine="exp")
    symbols: dict[Expr, Dummy] = {}
    masked = _masked(combined, symbols)
    return compute(masked).xreplace({symbol: node for node, symbol in symbols.items()})


def _is_transcendental(node: Expr) -> bool:
    return isinstance(node, Function) or not node.exp.is_Integer


def _degree(nodes: list[Expr]) -> int:
    """Degree of the polynomial that the nodes would form, from the numbers in their arguments."""
    held = [node.exp if node.is_Pow else node for node in nodes]
    numbers = set().union(*(expr.atoms(Rational) for expr in held))
    common = lcm(*(int(number.q) for number in numbers))
    return int(max((abs(number) * common for number in numbers), default=0))


def _masked(expr: Expr, symbols: dict[Expr, Dummy]) -> Expr:
    """`expr` with each outermost function or power replaced by a symbol of the same sign."""
    if isinstance(expr, Function | Pow) and _is_transcendental(expr):
        if expr not in symbols:
            name = f"f_{len(symbols)}"
            symbols[expr] = Dummy(name, real=expr.is_real, positive=expr.is_positive)
        return symbols[expr]
    return expr.func(*(_masked(arg, symbols) for arg in expr.args)) if expr.args else expr
