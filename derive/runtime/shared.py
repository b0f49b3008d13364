"""Functions that serve arrays as they stand, and kernels once numba compiles them.

A formula's text is NumPy.  Called from Python it takes numbers and arrays; called from a kernel the
same text is compiled for numbers.  Nothing here imports numba, which takes a third of a second.
"""

from collections.abc import Callable
from inspect import unwrap
from types import FunctionType
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

SHARED: list[Callable[..., Any]] = []
"""Functions that kernels may call, until numba is told of them."""


def shared(function: Function) -> Function:
    """Let kernels call a function whose text is NumPy or `math`."""
    SHARED.append(function)
    return function


def by_position(function: Callable[..., Any]) -> Callable[..., Any]:
    """The same code with keyword-only arguments taken by position, as numba asks."""
    function = unwrap(function)
    code = function.__code__
    count = code.co_argcount + code.co_kwonlyargcount
    code = code.replace(co_argcount=count, co_kwonlyargcount=0)
    return shared(FunctionType(code, function.__globals__, function.__name__))
