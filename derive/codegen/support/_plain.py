"""One load case in Python's own numbers, whose arithmetic is several times as quick as NumPy's.

Every step gives the bits that NumPy gives; powers alone may differ in the last one.  What Python
refuses and NumPy answers, a division by zero say, is left to NumPy.
"""

import math
from collections.abc import Callable, Iterator
from types import CodeType, FunctionType, SimpleNamespace
from typing import Any

import numpy as np

from ._logarithm import NORMAL, plain_log1p

Function = Callable[..., Any]

REFUSALS = (ArithmeticError, TypeError, ValueError)
"""What Python raises where NumPy's numbers go on: dividing by zero, at roots of what is negative,
where a number leaves float64 or the reals.
"""


def in_plain_numbers(function: Function) -> Function | None:
    """The same formula for Python's numbers; None if it reads what has no counterpart among them.

    It raises one of REFUSALS where NumPy's numbers go on, and warns of nothing.
    """
    code, read = function.__code__, {*_names(function.__code__)}
    if code.co_freevars or not read <= _KNOWN:
        return None
    return FunctionType(code, function.__globals__ | _COUNTERPARTS, function.__name__)


def _names(code: CodeType) -> Iterator[str]:
    """What a function reads that is not its own, and what the functions inside it read."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)


def plain_minimum(first: float, second: float) -> float:
    """np.minimum of two numbers."""
    return second if first > second or second != second else first


def plain_maximum(first: float, second: float) -> float:
    """np.maximum of two numbers."""
    return second if first < second or second != second else first


def plain_fmax(first: float, second: float) -> float:
    """np.fmax of two numbers."""
    return first if first >= second or second != second else second


def plain_kink_logarithm(left: float, right: float, offset: float, least: float = 0.0) -> float:
    """log(1 + (sqrt(left right) + min(left, right))/d), d = |offset|, `least` at least.

    Raises one of REFUSALS where the quotient leaves float64 or is no number, and beyond the edges.
    """
    quotient = (math.sqrt(left * right) + min(left, right)) / max(abs(offset), least)
    if not 0 <= quotient < math.inf:
        raise ValueError("no finite quotient")
    return plain_log1p(quotient)


# ------------------------------------------------------------------ what stands for NumPy's


def _sign(value: float) -> float:
    return 1.0 if value > 0 else -1.0 if value < 0 else abs(value)


def _only_where(exists: bool, *values: float) -> Any:
    found = values if exists else [math.nan] * len(values)
    return found if len(found) > 1 else found[0]


def _select(condition: bool, first: float, second: float) -> float:
    return first if condition else second


def _scaled(held: float, factor: float) -> float:
    return held * factor


def _of_numpy(name: str, of_python: Function) -> Function:
    """A function of NumPy's, whose last digits no other has; Python's refuses what it warns of."""
    known = getattr(np, name)

    def found(*values: float) -> float:
        if 0 < abs(of_python(*values)) < NORMAL:
            raise ArithmeticError("a denormal number")
        return float(known(*values))

    return found


_NUMPY = SimpleNamespace(
    pi=np.pi,
    inf=np.inf,
    e=np.e,
    euler_gamma=np.euler_gamma,
    abs=abs,
    sign=_sign,
    sqrt=math.sqrt,
    **{
        name: _of_numpy(name, getattr(math, name.replace("arc", "a")))
        for name in (
            *("arccos", "arccosh", "arcsin", "arcsinh", "arctan", "arctan2", "arctanh"),
            *("cos", "cosh", "exp", "expm1", "log", "log1p", "sin", "sinh", "tan", "tanh"),
        )
    },
)

_COUNTERPARTS = {
    "np": _NUMPY,
    "fmax": plain_fmax,
    "kink_logarithm": plain_kink_logarithm,
    "maximum": plain_maximum,
    "minimum": plain_minimum,
    "only_where": _only_where,
    "scaled": _scaled,
    "scaled_at_last": _scaled,
    "select": _select,
}

_BY_PARTS = ("_body", "load", "moment", "tilt", "edges", "second", "pressure")
"""A body that is added up part by part, and its sums: of Python's numbers they are such."""

_KNOWN = frozenset(
    (
        *_COUNTERPARTS,
        *vars(_NUMPY),
        *("LEAST", "MOST", "TINY", "Contact", "Edges"),
        *_BY_PARTS,
    )
)
"""What a formula may read."""
