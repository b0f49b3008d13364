"""Evaluation of a function of float64 on arguments that broadcast.

The temporary arrays of a formula are as large as its arguments.  Long arrays are cut into blocks,
so that the temporary arrays of one block stay in the processor's cache.
"""

import math
from collections.abc import Callable, Mapping
from functools import wraps
from inspect import Parameter as Argument
from inspect import signature
from typing import Any, TypeVar

import numpy as np

from .chunks import any_lazy, demand_array, is_lazy, over_chunks
from .words import Parameter, documented

Function = TypeVar("Function", bound=Callable[..., Any])
Numbers = dict[str, Any]

BLOCK = 16_384
"""Number of elements evaluated at once."""

_FLOAT64 = np.dtype(np.float64)
_OWN = (np.ndarray, np.generic)


def elementwise(*own: Parameter) -> Callable[[Function], Function]:
    """Let a formula for float64 take numbers and arrays of any real type, long arrays in blocks.

    own: the parameters of the body.

    Keyword-only arguments are constants of the material and the geometry: they become NaN unless
    positive and finite.  Dask arrays stay lazy.  Arrays of other libraries that follow NumPy's
    protocols are computed by those libraries.  No call raises a floating-point warning: a result
    that does not exist is NaN.

    The decorated function raises TypeError for an argument that is not a real number, and
    ValueError for shapes that do not broadcast; its docstring then says so.
    """

    def made(function: Function) -> Function:
        expected = signature(function)
        arguments = expected.parameters.values()
        positive = {p.name for p in arguments if p.kind is Argument.KEYWORD_ONLY}
        names = tuple(p.name for p in arguments if p.name not in positive)
        defaults = {p.name: p.default for p in arguments if p.default is not p.empty}
        result = expected.return_annotation
        kind = result if hasattr(result, "_fields") else None

        @wraps(function)
        def call(*args: Any, **kwargs: Any) -> Any:
            given = defaults | dict(zip(names, args, strict=False)) | kwargs
            if len(args) + len(kwargs) > len(given) or len(given) != len(expected.parameters):
                expected.bind(*args, **kwargs)  # raises Python's own error
            numbers = {name: real(given[name], name) for name in expected.parameters}
            for name in positive:
                numbers[name] = positive_or_nan(numbers[name])
            if any_lazy(numbers.values()):
                shape_of(numbers)
                return over_chunks(call, numbers)
            return evaluated(function, numbers, kind, BLOCK)

        return documented(*own)(call)  # type: ignore[return-value]

    return made


def evaluated(function: Callable[..., Any], numbers: Numbers, kind: Any, block: int) -> Any:
    """Evaluate a function of float64 on broadcast arguments, `block` elements at a time.

    kind: the named tuple that the function returns, or None for an array.
    """
    count = 1 if kind is None else len(kind._fields)
    with np.errstate(all="ignore"):
        if set(map(type, numbers.values())) == {np.float64}:
            result = function(**numbers)
            values = [np.float64(v) for v in (result if count > 1 else (result,))]
            return values[0] if kind is None else kind(*values)
        shape = shape_of(numbers)
        if any(map(is_foreign, numbers.values())):
            return function(**numbers)
        if math.prod(shape) > block:
            values = _in_blocks(function, numbers, count, block)
        else:
            result = function(**numbers)
            values = [_shaped(v, shape) for v in (result if count > 1 else (result,))]
    return values[0] if kind is None else kind(*values)


def _shaped(value: Any, shape: tuple[int, ...]) -> Any:
    """A result broadcast to the shape of the arguments."""
    return value if np.shape(value) == shape else np.broadcast_to(value, shape).copy()


def _in_blocks(function: Callable[..., Any], numbers: Numbers, count: int, block: int) -> list[Any]:
    fixed = {name: v for name, v in numbers.items() if not v.ndim}
    varying = {name: v for name, v in numbers.items() if v.ndim}
    flags: Any = [["readonly"]] * len(varying) + [["writeonly", "allocate"]] * count
    blocks = np.nditer(
        [*varying.values(), *[None] * count],
        ["external_loop", "buffered"],
        flags,
        [_FLOAT64] * (len(varying) + count),
        buffersize=block,
    )
    with blocks:
        for arrays in blocks:
            inputs, outputs = arrays[: len(varying)], arrays[len(varying) :]
            result = function(**fixed, **dict(zip(varying, inputs, strict=True)))
            for out, value in zip(outputs, result if count > 1 else (result,), strict=True):
                out[...] = value
        return list(blocks.operands[len(varying) :])


def shape_of(numbers: Mapping[str, Any]) -> tuple[int, ...]:
    """The common shape of the arguments; a length that Dask does not know yet fits any other.

    Raises ValueError with the names and shapes of the arguments if there is no common shape.
    """
    shapes = {value.shape for value in numbers.values()}
    if len(shapes) == 1:
        return shapes.pop()
    try:
        return np.broadcast_shapes(*(tuple(1 if n != n else n for n in shape) for shape in shapes))
    except ValueError:
        listed = ", ".join(f"{name} {v.shape}" for name, v in numbers.items() if v.ndim)
        raise ValueError(
            f"the arguments must broadcast to one shape; their shapes are {listed}"
        ) from None


def positive_or_nan(value: Any) -> Any:
    """A constant of the material or the geometry; NaN unless it is positive and finite."""
    if type(value) is np.float64:
        return value if 0 < value < np.inf else np.float64(np.nan)
    if is_lazy(value):
        return value  # each chunk is tested when it is computed
    return np.where((value > 0) & (value < np.inf), value, np.nan)


def is_foreign(value: Any) -> bool:
    """Whether the value is an array of another library that follows NumPy's protocols."""
    return not isinstance(value, _OWN) and hasattr(value, "__array_function__")


def real(value: Any, label: str) -> Any:
    """A real number as np.float64, anything else as a float64 array with NaN for masked elements.

    A Dask array is returned unchanged: each chunk is converted to float64 when it is computed.  A
    long array of another real type is also returned unchanged: each block is converted when it is
    evaluated.

    Raises TypeError for anything that is not a real number.
    """
    if type(value) is float or type(value) is np.float64:
        return np.float64(value)
    if type(value) is np.ndarray and value.dtype == _FLOAT64 and value.ndim:
        return value
    demand_array(value, label)
    foreign = is_foreign(value)
    try:
        array = value if foreign else np.asanyarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
        if is_lazy(array) or (array.size > BLOCK and type(array) is np.ndarray):
            return array
        with np.errstate(all="ignore"):
            numbers = array.astype(np.float64)
    except (AttributeError, TypeError, ValueError):
        shown = f"{type(value).__name__} {value!r:.60}"
        raise TypeError(
            f"{label} must be a real number or an array of real numbers; got {shown}"
        ) from None
    return numbers if foreign else np.asarray(np.ma.filled(numbers, np.nan))[()]
