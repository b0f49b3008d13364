"""Expressions as functions of numbers, whatever names their symbols have."""

import builtins
import math
from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import numpy as np
from sympy import Expr, Symbol, Tuple, cse, evaluate, lambdify, numbered_symbols

_LIBRARIES = (builtins, math, mpmath, np)
"""Whose names a function may call."""


def compiled(
    symbols: Sequence[Symbol], expr: Expr | Sequence[Expr], shared: bool = False, **options: Any
) -> Callable[..., Any]:
    """`lambdify`, but a parameter may bear the name of a function.

    shared: compute once what the expression repeats.

    >>> from sympy import sqrt, symbols
    >>> root = symbols("sqrt", positive=True)
    >>> compiled([root], 1 + sqrt(root), modules="math")(4)
    3.0
    """
    own = {s: Symbol(f"_{s.name}", **s.assumptions0) for s in symbols if _is_called(s.name)}
    with evaluate(False):  # the same expression: SymPy may see one that is built anew otherwise
        renamed = _all(expr).xreplace(own) if own else expr
    taken = [own.get(symbol, symbol) for symbol in symbols]
    return lambdify(taken, renamed, cse=_repeated if shared else False, **options)


def _is_called(name: str) -> bool:
    return any(hasattr(library, name) for library in _LIBRARIES)


def _all(expr: Expr | Sequence[Expr]) -> Any:
    return expr if isinstance(expr, Expr) else Tuple(*expr)


def _repeated(expr: Any, **_: Any) -> Any:
    """What expressions repeat, by names that no parameter may bear."""
    return cse(expr, symbols=numbered_symbols("_shared_"), list=False)
