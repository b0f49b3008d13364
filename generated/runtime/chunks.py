"""Dask arrays, chunk by chunk: apply the functions for NumPy arrays to arrays not yet computed.

Nothing is imported from Dask; a caller that passes such an array has already loaded it.
"""

import sys
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np

Array = Any


def is_lazy(value: Any) -> bool:
    """Whether the value is a Dask array."""
    dask = sys.modules.get("dask.array")
    return dask is not None and isinstance(value, dask.Array)


def any_lazy(values: Iterable[Any]) -> bool:
    """Whether any of the values is a Dask array."""
    return "dask.array" in sys.modules and any(map(is_lazy, values))


def demand_array(value: Any, label: str) -> None:
    """Raise TypeError for a lazy value other than a Dask array: it would be computed as a whole."""
    graph = getattr(value, "__dask_graph__", None)
    if graph is not None and not is_lazy(value) and graph() is not None:
        raise TypeError(
            f"{label} is lazy but not a Dask array; got {type(value).__name__}: pass the Dask "
            "array in it, from .data of an xarray object, .to_dask_array(lengths=True) of a data "
            "frame, or dask.array.from_delayed of a task"
        )


def over_chunks(
    call: Callable[..., Any],
    name: str,
    numbers: Mapping[str, Any],
    groups: Iterable[Iterable[str]],
    axes: Mapping[str, str] | None = None,
    places: tuple[int, ...] = (),
) -> Any:
    """The result of a call with arguments some of which are lazy arrays; it is lazy, too.

    call: takes a dictionary for each group of arguments, and the other ones by their names.
    name: by which Dask names its tasks.
    numbers: numbers and arrays that broadcast, by name.
    axes: if the last axis is time, which of time t and places p the last axes of each result are.
    places: the shape of the places.

    Chunks are unified as in Dask's own functions; time must lie in one chunk.  All fields of a
    chunk's result are one task.  A call with empty arrays determines the types of the results, and
    raises the errors of invalid arguments at once.

    Raises ValueError if time lies in several chunks.
    """
    instants = 0
    if axes is not None:
        numbers = {
            k: v.reshape(1) if _ndim(v) == 0 and is_lazy(v) else v for k, v in numbers.items()
        }
        instants = _instants(numbers)
    known: dict[str, Any] = {"call": call, "names": tuple(numbers)}
    known["groups"] = [*map(tuple, groups)]
    sample = _on_chunk(*(_empty(v, instants) for v in numbers.values()), **known)
    many, blockwise = isinstance(sample, tuple), sys.modules["dask.array"].blockwise
    full = _axes(max(map(_ndim, numbers.values())))
    pairs = [x for v in numbers.values() for x in (v, _axes(_ndim(v)) if _is_array(v) else None)]
    meta = sample[0] if many else sample
    chunked = blockwise(_on_chunk, full, *pairs, **known, token=name, meta=meta)
    if not many:
        return chunked
    beyond = {-1 - i: length for i, length in enumerate(places)}
    fields = []
    for i, field in enumerate(sample._fields):
        own, new = full, dict[int, int]()
        if axes is not None:
            new = beyond if "p" in axes[field] else {}
            own = (*(full if "t" in axes[field] else full[:-1]), *new)
        token = f"{name}-{field}"
        lazy = partial(blockwise, _field, own, chunked, full, i=i, new_axes=new, token=token)
        fields.append(None if sample[i] is None else lazy(meta=sample[i]))
    return type(sample)(*fields)


def _on_chunk(
    *values: Array, call: Callable[..., Any], names: tuple[str, ...], groups: list[tuple[str, ...]]
) -> Any:
    """The result for one chunk."""
    numbers = dict(zip(names, values, strict=True))
    grouped = [{name: numbers.pop(name) for name in group} for group in groups]
    return call(*grouped, **numbers)


def _field(chunk: Any, i: int) -> Array:
    """A field of the result for one chunk, which Dask wraps in a list if the field has no time."""
    return chunk[0][i] if isinstance(chunk, list) else chunk[i]


def _is_array(value: Any) -> bool:
    """Whether the value has chunks, or is to be cut into chunks."""
    return is_lazy(value) or _ndim(value) > 0


def _ndim(value: Any) -> int:
    return getattr(value, "ndim", 0)


def _axes(ndim: int) -> tuple[int, ...]:
    """Axes numbered from the last one, in the way arrays broadcast."""
    return tuple(reversed(range(ndim)))


def _empty(value: Any, instants: int) -> Any:
    """An empty array in place of the value; time has `instants` unless they are 0."""
    if not _is_array(value):
        return value
    shape = [0] * value.ndim
    if instants:
        shape = [0] * max(value.ndim - 1, 1) + [instants]
    return np.zeros_like(value._meta if is_lazy(value) else value, shape=tuple(shape))


def _instants(given: Mapping[str, Any]) -> int:
    """The number of instants; two if it is not known yet.

    Raises ValueError if the instants lie in several chunks.
    """
    lengths = [2]
    for name, value in given.items():
        if is_lazy(value) and any(n > 1 for n in value.numblocks[-1:]):
            raise ValueError(
                f"the last axis of {name} is time and must lie in one chunk; its chunks are "
                f"{value.chunks[-1]}: pass {name}.rechunk({{-1: -1}})"
            )
        if _ndim(value):
            lengths += [n for n in value.shape[-1:] if n == n]
    return max(lengths)
