"""Functions that take arrays in NumPy and that kernels can also call, compiled by numba.

A formula is written in NumPy.  Called from Python it takes numbers and arrays; called from a kernel
the same source is compiled for numbers.  This module does not import numba, because that takes a
third of a second.
"""

from collections.abc import Callable
from inspect import unwrap
from types import FunctionType
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

SHARED: list[Callable[..., Any]] = []
"""Functions that kernels may call and that are not yet registered with numba."""


def shared(function: Function) -> Function:
    """Let kernels call a function that is written with NumPy or `math`."""
    SHARED.append(function)
    return function


def by_position(function: Callable[..., Any]) -> Callable[..., Any]:
    """The same code with keyword-only arguments taken by position, as numba requires."""
    function = unwrap(function)
    code = function.__code__
    count = code.co_argcount + code.co_kwonlyargcount
    code = code.replace(co_argcount=count, co_kwonlyargcount=0)
    return shared(FunctionType(code, function.__globals__, function.__name__))
