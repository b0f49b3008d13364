"""How a formula written for one block of float64 serves every input.

A formula's temporaries are as large as its argument.  Evaluated over blocks that fit the
processor's cache they cost little; over a whole large array they cost more than the arithmetic.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import wraps
from inspect import signature
from itertools import product
from typing import Any, TypeVar

import numpy as np

Function = TypeVar("Function", bound=Callable[..., Any])
Shape = tuple[int, ...]

BLOCK = 16_384
"""Elements evaluated at once: a few arrays of this length stay in a core's own cache."""


def elementwise(function: Function) -> Function:
    """Let `function` take anything that broadcasts, and compute large arrays in blocks.

    Numbers and NumPy arrays of any real type become float64; arrays of other libraries are passed
    through as they are.  No floating-point warning leaves the call: what does not exist is NaN.

    Raises TypeError for what is no real number, ValueError for shapes that do not broadcast.
    """
    names = tuple(signature(function).parameters)

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        given = (*args, *kwargs.values())
        if any(map(_foreign, given)):
            return function(*args, **kwargs)
        labels = (*names[: len(args)], *kwargs)
        values = [_float64(v, label) for v, label in zip(given, labels, strict=False)]
        count = len(args)

        def on(parts: Sequence[Any]) -> Any:
            return function(*parts[:count], **dict(zip(kwargs, parts[count:], strict=True)))

        shapes = {v.shape for v in values if v.ndim}
        with np.errstate(all="ignore"):
            if len(shapes) < 2 and all(v.size <= BLOCK for v in values):
                return _plain(on(values))
            return _in_blocks(on, values, _broadcast(values, labels))

    return call  # type: ignore[return-value]


def _foreign(value: Any) -> bool:
    """Whether a value is an array of another library."""
    return hasattr(value, "__array_function__") and not isinstance(value, np.ndarray | np.generic)


def _float64(value: Any, label: str) -> Any:
    """A number as np.float64, anything else as an array; masked elements are NaN."""
    if isinstance(value, float | int):
        return np.float64(value)
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    if isinstance(value, np.ma.MaskedArray):
        return np.ma.filled(value.astype(np.float64), np.nan)
    try:
        return np.asarray(value).astype(np.float64, casting="same_kind")[()]
    except (TypeError, ValueError):
        found = f"{type(value).__name__} {value!r:.60}"
        raise TypeError(f"{label} must be a real number or an array of such; got {found}") from None


def _broadcast(values: Sequence[Any], labels: Sequence[str]) -> Shape:
    try:
        return np.broadcast_shapes(*(v.shape for v in values))
    except ValueError:
        shapes = ", ".join(f"{n} {v.shape}" for n, v in zip(labels, values, strict=False) if v.ndim)
        raise ValueError(
            f"the arguments must broadcast to one shape; their shapes are {shapes}"
        ) from None


def _plain(result: Any) -> Any:
    """Arrays without dimensions as NumPy scalars."""
    if isinstance(result, tuple):
        return type(result)(*(v[()] for v in result))
    return result[()]


def _in_blocks(on: Callable[[Sequence[Any]], Any], values: Sequence[Any], shape: Shape) -> Any:
    """The result of `on` over the whole of `shape`, block by block."""
    padded = [v.reshape((1,) * (len(shape) - v.ndim) + v.shape) if v.ndim else v for v in values]
    kind: Any = None
    out: list[Any] = []
    for index in _blocks(shape):
        result = on([_part(v, index) for v in padded])
        parts = result if isinstance(result, tuple) else (result,)
        if not out:
            kind = type(result)
            out = [np.empty(shape) for _ in parts]
        for whole, part in zip(out, parts, strict=True):
            whole[index] = part
    return kind(*out) if issubclass(kind, tuple) else out[0]


def _part(value: Any, index: tuple[slice, ...]) -> Any:
    """The block of one argument; along an axis of length one it is the same everywhere."""
    if not value.ndim:
        return value
    whole = slice(None)
    return value[tuple(i if n > 1 else whole for i, n in zip(index, value.shape, strict=True))]


def _blocks(shape: Shape) -> Iterator[tuple[slice, ...]]:
    """Index tuples that cut `shape` into blocks: whole inner axes, a slice of one, single rows."""
    axis, inner = len(shape) - 1, 1
    while axis > 0 and inner * shape[axis] <= BLOCK:
        inner *= shape[axis]
        axis -= 1
    step = max(1, BLOCK // max(1, inner))
    rest = (slice(None),) * (len(shape) - 1 - axis)
    outer = [[slice(i, i + 1) for i in range(n)] for n in shape[:axis]]
    for front in product(*outer):
        for start in range(0, max(1, shape[axis]), step):
            yield (*front, slice(start, start + step), *rest)
