"""Make numerical functions from expressions, whatever the names of their symbols."""

import builtins
import math
from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import numpy as np
from sympy import Expr, Symbol, Tuple, cse, evaluate, lambdify, numbered_symbols

_LIBRARIES = (builtins, math, mpmath, np)
"""Libraries whose functions a compiled function may call."""


def compiled(
    symbols: Sequence[Symbol], expr: Expr | Sequence[Expr], shared: bool = False, **options: Any
) -> Callable[..., Any]:
    """Like `lambdify`, but a parameter may have the name of a function.

    shared: compute repeated subexpressions only once.

    >>> from sympy import sqrt, symbols
    >>> root = symbols("sqrt", positive=True)
    >>> compiled([root], 1 + sqrt(root), modules="math")(4)
    3.0
    """
    own = {s: Symbol(f"_{s.name}", **s.assumptions0) for s in symbols if _is_called(s.name)}
    with evaluate(False):  # else SymPy may change the expression
        renamed = _all(expr).xreplace(own) if own else expr
    taken = [own.get(symbol, symbol) for symbol in symbols]
    return lambdify(taken, renamed, cse=_repeated if shared else False, **options)


def _is_called(name: str) -> bool:
    return any(hasattr(library, name) for library in _LIBRARIES)


def _all(expr: Expr | Sequence[Expr]) -> Any:
    return expr if isinstance(expr, Expr) else Tuple(*expr)


def _repeated(expr: Any, **_: Any) -> Any:
    """Repeated subexpressions, under names that no parameter may have."""
    return cse(expr, symbols=numbered_symbols("_shared_"), list=False)
