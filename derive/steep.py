"""Simplifying expressions of functions of very different steepness.

In:  an expression, and an operation such as `factor` or `simplify`.
Out: its result, without treating exp(99999 x/b) as a polynomial of that degree in exp(x/b).
"""

from collections.abc import Callable
from math import lcm

from sympy import Dummy, Expr, Function, Pow, Rational, powsimp

_MOST = 50
"""Degree up to which functions and powers may be treated as polynomials in the smallest of them."""


def gently(compute: Callable[[Expr], Expr], expr: Expr) -> Expr:
    """compute(expr); steep functions and powers are replaced by symbols meanwhile."""
    nodes = [node for node in expr.atoms(Function, Pow) if _is_transcendental(node)]
    if _degree(nodes) <= _MOST:
        return compute(expr)
    combined = powsimp(expr, combine="exp")
    symbols: dict[Expr, Dummy] = {}
    masked = _masked(combined, symbols)
    return compute(masked).xreplace({symbol: node for node, symbol in symbols.items()})


def _is_transcendental(node: Expr) -> bool:
    return isinstance(node, Function) or not node.exp.is_Integer


def _degree(nodes: list[Expr]) -> int:
    """Degree of the polynomial that they would form, from the numbers in their arguments."""
    held = [node.exp if node.is_Pow else node for node in nodes]
    numbers = set().union(*(expr.atoms(Rational) for expr in held))
    common = lcm(*(int(number.q) for number in numbers))
    return int(max((abs(number) * common for number in numbers), default=0))


def _masked(expr: Expr, symbols: dict[Expr, Dummy]) -> Expr:
    """`expr` with a symbol of the same sign for each outermost function or power."""
    if isinstance(expr, Function | Pow) and _is_transcendental(expr):
        if expr not in symbols:
            name = f"f_{len(symbols)}"
            symbols[expr] = Dummy(name, real=expr.is_real, positive=expr.is_positive)
        return symbols[expr]
    return expr.func(*(_masked(arg, symbols) for arg in expr.args)) if expr.args else expr
