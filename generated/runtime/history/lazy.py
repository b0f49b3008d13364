"""Histories of Dask arrays, computed chunk by chunk with Dask's `apply_gufunc`."""

import math
import sys
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from ..arrays import Numbers, shape_of
from ..chunks import is_lazy

WHOLE = ("intervals", "regime", "rounds")
"""Results that are integers."""


def over_chunks(
    call: Callable[..., Any], kind: Any, axes: Mapping[str, str], numbers: Numbers, x: Any, tol: Any
) -> Any:
    """Lazy results of a function of histories, some of whose arguments are Dask arrays.

    kind: the named tuple that `call` returns.
    axes: axes of each result, as in the signature of a generalised function: t is time, p a point.
    numbers: arguments that broadcast, by name; time lies along the last axis.

    Raises ValueError if the time axis has several chunks.
    """
    dask = sys.modules["dask.array"]
    numbers = {
        name: v.reshape(1) if is_lazy(v) and v.ndim == 0 else v for name, v in numbers.items()
    }
    *_, instants = shape_of(numbers)
    held = {name: value for name, value in numbers.items() if value.ndim == 0}
    long = {
        name: (dask if is_lazy(v) else np).broadcast_to(v, (*v.shape[:-1], instants))
        for name, v in numbers.items()
        if v.ndim
    }
    for name, value in long.items():
        if is_lazy(value) and value.numblocks[-1] > 1:
            raise ValueError(
                f"the last axis of {name} is time and must lie in one chunk; its chunks are "
                f"{value.chunks[-1]}: pass {name}.rechunk({{-1: -1}})"
            )
    fields = [name for name in kind._fields if x is not None or "p" not in axes[name]]
    computed = dask.apply_gufunc(
        partial(
            _on_chunk,
            call=call,
            names=tuple(long),
            fields=fields,
            given={**held, "x": None if x is None else np.ravel(x), "tol": tol},
        ),
        f"{','.join(['(t)'] * len(long))}->{','.join(f'({axes[name]})' for name in fields)}",
        *long.values(),
        output_dtypes=[np.int64 if name in WHOLE else np.float64 for name in fields],
        output_sizes={} if x is None else {"p": math.prod(np.shape(x))},
    )
    results: dict[str, Any] = dict.fromkeys(kind._fields) | dict(zip(fields, computed, strict=True))
    for name in fields:
        if "p" in axes[name]:
            results[name] = results[name].reshape((*results[name].shape[:-1], *np.shape(x)))
    return kind(**results)


def _on_chunk(
    *values: Any,
    call: Callable[..., Any],
    names: tuple[str, ...],
    fields: list[str],
    given: Mapping[str, Any],
) -> tuple[Any, ...]:
    """The results for one chunk."""
    result = call(**dict(zip(names, values, strict=True)), **given)
    return tuple(getattr(result, name) for name in fields)
