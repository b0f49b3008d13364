"""How a formula written for one block of float64 serves every input.

A formula's temporaries are as large as its argument.  Evaluated over blocks that fit the
processor's cache they cost little, over a whole large array they cost more than the arithmetic.
"""

from collections.abc import Callable, Iterator
from functools import wraps
from itertools import product
from typing import Any, TypeVar

import numpy as np

Function = TypeVar("Function", bound=Callable[..., Any])

BLOCK = 16_384
"""Elements evaluated at once: a few arrays of this length stay in a core's own cache."""


def elementwise(function: Function) -> Function:
    """Let `function` take anything that broadcasts, and compute large arrays in blocks.

    Numbers and NumPy arrays of any real type become float64; arrays of other libraries are passed
    through as they are.  No floating-point warning leaves the call: what does not exist is NaN.
    """

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        given = [*args, *kwargs.values()]
        if any(hasattr(v, "__array_function__") and not isinstance(v, _NUMPY) for v in given):
            return function(*args, **kwargs)
        arrays = [np.asarray(v, dtype=np.float64) for v in given]
        with np.errstate(all="ignore"):
            if all(v.size <= BLOCK for v in arrays) and _small(arrays):
                return _plain(
                    function(*arrays[: len(args)], **dict(zip(kwargs, arrays[len(args) :])))
                )
            return _in_blocks(function, arrays, len(args), tuple(kwargs))

    return call  # type: ignore[return-value]


_NUMPY = (np.ndarray, np.generic)


def _small(arrays: list[Any]) -> bool:
    """Whether the result fits one block; arrays of one size, or one among numbers, surely do."""
    return sum(v.size > 1 for v in arrays) < 2 or (
        int(np.prod(np.broadcast_shapes(*(v.shape for v in arrays)))) <= BLOCK
    )


def _plain(result: Any) -> Any:
    """Arrays without dimensions as NumPy scalars."""
    if isinstance(result, tuple):
        return type(result)(*(v[()] for v in result))  # type: ignore[call-arg]
    return result[()]


def _in_blocks(
    function: Callable[..., Any], arrays: list[Any], positional: int, names: tuple[str, ...]
) -> Any:
    shape = np.broadcast_shapes(*(v.shape for v in arrays))
    padded = [v.reshape((1,) * (len(shape) - v.ndim) + v.shape) for v in arrays]
    out: Any = None
    for index in _blocks(shape):
        parts = [
            v[tuple(i if n > 1 else slice(None) for i, n in zip(index, v.shape))] for v in padded
        ]
        result = function(*parts[:positional], **dict(zip(names, parts[positional:])))
        if out is None:
            count = len(result) if isinstance(result, tuple) else 1
            out = [np.empty(shape) for _ in range(count)]
            kind = type(result)
        for whole, part in zip(out, result if isinstance(result, tuple) else (result,)):
            whole[index] = part
    return kind(*out) if issubclass(kind, tuple) else out[0]


def _blocks(shape: tuple[int, ...]) -> Iterator[tuple[slice, ...]]:
    """Index tuples that cut `shape` into blocks: whole inner axes, a slice of one, single outer
    rows.""" axis, inner = len(shape) - 1, 1
    while axis > 0 and inner * shape[axis] <= BLOCK:
        inner *= shape[axis]
        axis -= 1
    step = max(1, BLOCK // inner)
    rest = (slice(None),) * (len(shape) - 1 - axis)
    outer = [[slice(i, i + 1) for i in range(n)] for n in shape[:axis]]
    for front in product(*outer):
        for start in range(0, shape[axis], step):
            yield (*front, slice(start, start + step), *rest)
