"""The one way from arguments to results: numbers and arrays are checked, broadcast and computed.

`evaluated` applies a formula written in NumPy to arrays; `solved` lets a compiled loop fill a table
with one row per case.  In both, arguments are real numbers, lists or arrays of any real type;
constants of material and geometry become NaN unless positive and finite; no call raises a
floating-point warning, because a result that does not exist is NaN; results are float64 of the
broadcast shape.  Dask arrays stay lazy (chunks.py).
"""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from .body import Body
from .chunks import any_lazy, demand_array, is_lazy, over_chunks

Numbers = dict[str, Any]


def evaluated(
    function: Callable[..., Any],
    given: Mapping[str, Any],
    constants: Mapping[str, Any],
    kind: Any = None,
) -> Any:
    """A formula of float64, on arguments that broadcast.

    function: takes the values of `given` and `constants` in their order.
    kind: the named tuple that it returns, or None for a single array.

    Raises TypeError for an argument that is not a real number or an array of real numbers, and
    ValueError for shapes that do not broadcast.
    """
    numbers = numbers_of(given, constants)
    shape = shape_of(numbers)
    if any_lazy(numbers.values()):
        call = partial(evaluated, function, kind=kind)
        return over_chunks(call, function.__name__.lstrip("_"), numbers, (given, constants))
    count = 1 if kind is None else len(kind._fields)
    with np.errstate(all="ignore"):
        if shape:
            values = _in_blocks(function, [*numbers.values()], count)
        else:
            result = function(*numbers.values())
            values = [np.float64(v) for v in (result if count > 1 else (result,))]
    return values[0] if kind is None else kind(*values)


def _in_blocks(function: Callable[..., Any], values: list[Any], count: int) -> list[Any]:
    """The results of a formula, computed in blocks that stay in the processor's cache."""
    varying = [v for v in values if v.ndim]
    flags: Any = [["readonly"]] * len(varying) + [["writeonly", "allocate"]] * count
    blocks = np.nditer(
        [*varying, *[None] * count],
        ["external_loop", "buffered", "zerosize_ok"],
        flags,
        [np.float64] * (len(varying) + count),
    )
    with blocks:
        for arrays in blocks:
            inputs = iter(arrays)
            result = function(*[next(inputs) if v.ndim else v for v in values])
            for out, value in zip(inputs, result if count > 1 else (result,), strict=True):
                out[...] = value
        return list(blocks.operands[len(varying) :])


def solved(
    loop: Callable[..., None],
    body: Body,
    given: Mapping[str, Any],
    constants: Mapping[str, Any],
    own: Mapping[str, Any],
    kind: Any = None,
    whole: tuple[str, ...] = (),
) -> Any:
    """What a loop finds for every case of arguments that broadcast.

    loop: fills a table of results; it takes the law of the body, a row per case of `given`
        and `constants` in their order, and a row of the body's parameters `own`.
    kind: the named tuple of the results, or None for a single array.
    whole: names of the results that are integers.

    Raises what `evaluated` raises.
    """
    numbers = numbers_of(given, {**constants, **own})
    shape = shape_of(numbers)
    if any_lazy(numbers.values()):
        call = partial(solved, loop, body, kind=kind, whole=whole)
        name = loop.__name__.removeprefix("each_")
        return over_chunks(call, name, numbers, (given, constants, own))
    row, rest = len(given) + len(constants), [*numbers.values()]
    cases = _table(rest[:row], shape)
    out = np.empty((len(cases), 1 if kind is None else len(kind._fields)))
    loop(body.law, cases, _table(rest[row:], shape), out)
    columns = [*out[0]] if not shape else [column.reshape(shape) for column in out.T]
    if kind is None:
        return columns[0]
    for name in whole:
        at = kind._fields.index(name)
        columns[at] = columns[at].astype(np.int64)
    return kind(*columns)


def _table(values: list[Any], shape: tuple[int, ...]) -> Any:
    """The values of all cases, one row per case."""
    if not shape:
        return np.array([values], dtype=np.float64)
    table = np.empty((*shape, len(values)))
    for i, value in enumerate(values):
        table[..., i] = value
    return table.reshape(math.prod(shape), len(values))


def numbers_of(given: Mapping[str, Any], constants: Mapping[str, Any]) -> Numbers:
    """All arguments as float64, by name; constants become NaN unless positive and finite."""
    numbers = {name: real(value, name) for name, value in given.items()}
    for name, value in constants.items():
        number = real(value, name)
        if type(number) is np.float64:
            numbers[name] = number if 0 < number < math.inf else np.float64(np.nan)
        elif is_lazy(number):
            numbers[name] = number  # each chunk is tested when it is computed
        else:
            numbers[name] = np.where((number > 0) & (number < np.inf), number, np.nan)
    return numbers


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


def real(value: Any, label: str) -> Any:
    """A real number as np.float64, anything else as a float64 array with NaN for masked elements.

    A Dask array is returned unchanged: each chunk is converted to float64 when it is computed.

    Raises TypeError for anything that is not a real number or an array of real numbers.
    """
    if type(value) is float or type(value) is np.float64:
        return np.float64(value)
    if type(value) is np.ndarray and value.dtype.char == "d" and value.ndim:
        return value
    demand_array(value, label)
    try:
        array = value if is_lazy(value) else np.asanyarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
        if is_lazy(array):
            return array
        with np.errstate(all="ignore"):
            return np.asarray(np.ma.filled(array.astype(np.float64), np.nan))[()]
    except (AttributeError, RuntimeError, TypeError, ValueError):  # as libraries refuse NumPy
        kind = type(value)
        known = kind.__module__.partition(".")[0] in ("builtins", "numpy")
        name = kind.__qualname__ if known else f"{kind.__module__}.{kind.__qualname__}"
        raise TypeError(
            f"{label} must be a real number or a list, NumPy or Dask array of real numbers; got "
            f"{name} {value!r:.60}"
        ) from None


def number(value: Any, name: str, kind: str = "finite") -> float:
    """One number that is "finite", "non-negative finite" or "positive finite".

    Raises TypeError if it is not a real number, ValueError if it is not of this kind.
    """
    found = real(value, name)
    signs = {"finite": (-1, 0, 1), "non-negative finite": (0, 1), "positive finite": (1,)}
    if np.ndim(found) or not (math.isfinite(found) and np.sign(found) in signs[kind]):
        raise ValueError(f"{name} must be one {kind} number; got {value!r:.60}")
    return float(found)


def demand_order(order: Any) -> None:
    """Raise TypeError unless the order is a whole number, ValueError unless it is 1 or 2."""
    if isinstance(order, bool) or not isinstance(order, int | np.integer):
        raise TypeError(f"order must be a whole number; got {order!r:.60}")
    if order not in (1, 2):
        raise ValueError(f"order must be 1 or 2; got {order}")
