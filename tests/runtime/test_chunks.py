"""Dask arrays in, Dask arrays out: lazily, chunk by chunk.

Everything here runs in this process; tests/generated/test_cluster.py has the distributed scheduler,
and tests/runtime/test_cycle.py asks every function that is solved for.
"""

import doctest
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import dask
import dask.array as da
import numpy as np
import pytest
from dask.delayed import delayed
from numpy.testing import assert_allclose, assert_array_equal

from generated import hyperbola, wedge
from generated.runtime.types import Contact

F = 0.5
LAW: Mapping[str, Any] = {"E_star": 1.0, "phi": 0.25}
CYLINDER: Mapping[str, Any] = {"f": F, "E_star": 1.0, "R": 1.0}


@pytest.fixture(autouse=True)
def in_this_thread() -> Iterator[None]:
    with dask.config.set(scheduler="synchronous"):
        yield


# ------------------------------------------------------------------ what may be mixed


def test_numbers_arrays_and_constants_mix() -> None:
    x, a = np.linspace(-0.9, 0.9, 4), np.array([[1.0], [1.25], [1.5]])
    phi = np.array([[0.1], [0.2], [0.3]])
    found = wedge.pressure(
        da.from_array(x, chunks=2), a, 1.25, E_star=da.from_array(1.5), phi=da.from_array(phi)
    )
    assert found.chunks == ((3,), (2, 2))
    assert_allclose(found.compute(), wedge.pressure(x, a, 1.25, E_star=1.5, phi=phi), rtol=1e-14)


def unknown(values: np.ndarray) -> Any:
    """Chunks whose lengths are not known: those above the middle."""
    whole = da.from_array(values, chunks=4)
    return whole[whole > 1.5]


def test_lengths_may_be_unknown() -> None:
    values, own = np.linspace(1, 2, 11), {"E_star": 1.0, "b": 0.5, "phi": 0.25}
    states = [hyperbola.contact(P, 0.25, **own) for P in (unknown(values), values[values > 1.5])]
    zone, known = (hyperbola.stick_zone(s, s, 0.1 * s.a, 0.0, f=F, **own) for s in states)
    assert np.isnan(states[0].a.shape[0])
    assert_allclose(zone.m.compute(), known.m, rtol=1e-12)
    assert_array_equal(zone.regime.compute(), known.regime)
    with pytest.raises(ValueError, match="compute_chunk_sizes"):
        wedge.contact(unknown(values), np.ones(6), **LAW)


# ------------------------------------------------------------------ each chunk once


def test_from_loads_to_slip_each_chunk_is_computed_once_and_alone() -> None:
    sizes: list[int] = []

    def counted(block: Any) -> Any:
        sizes.append(block.size)
        return block

    P = da.linspace(1, 2, 7, chunks=3).map_blocks(counted, meta=np.empty(0))
    own = {"E_star": 1.0, "b": 0.5, "phi": 0.25}
    state = hyperbola.contact(P, 0.1, **own)
    zone = hyperbola.stick_zone(state, state, 0.1, 0.0, f=F, **own)
    slip = [da.histogram(v, bins=4, range=(0, 2))[0] for v in (state.a - zone.m, state.c - zone.n)]
    assert sizes == []
    dask.compute(*slip, zone.regime.max())
    assert sorted(sizes) == [1, 3, 3]


# ------------------------------------------------------------------ what is refused, at the call

ONES = da.ones(3, chunks=2)
HERE = Contact(1.0, 1.0, 0.0)


LAZY = Contact(ONES, 1.0, 0.0)
STATE: Mapping[str, Any] = {"f": F, **LAW}


def wrong(kind: Any) -> Any:
    return da.from_array(np.array([1, 2, 3]).astype(kind), chunks=2)


@pytest.mark.parametrize(
    ("kind", "words", "call"),
    [
        (ValueError, r"must broadcast to one shape; their shapes are.* P \(3,\)",
         lambda: wedge.contact(ONES, np.ones(9), **LAW)),
        (ValueError, r"shapes are first.a \(3,\), second.a \(4,\)",
         lambda: wedge.stick_zone(LAZY, Contact(da.ones(4), 1.0, 0.0), 0.1, 0.0, **STATE)),
        *((TypeError, "a must be a real number or a list.*; got dask.*Array dask.array",
           lambda of=of: wedge.load(wrong(of), 1.0, **LAW))
          for of in (complex, object, "U3", bool, "M8[s]")),
        (TypeError, "dQ must be a real number",
         lambda: wedge.stick_zone(HERE, HERE, wrong(complex), 0.0, **STATE)),
        (ValueError, r"the last axis of Q is time and must lie in one chunk.*\(5, 5\).*rechunk",
         lambda: wedge.march(1.0, 0.0, da.ones((4, 10), chunks=(2, 5)), 0.0, **STATE)),
        (ValueError, r"must have 2 or more values; got \(4, 1\)",
         lambda: wedge.march(1.0, 0.0, da.ones((4, 1), chunks=(2, 1)), 0.0, **STATE)),
        (TypeError, r"slip_zones\(\) got an unexpected keyword argument 'surplus'",
         lambda: wedge.slip_zones(ONES, 1.0, 0.1, 0.0, surplus=1, **STATE)),
        (TypeError, "second must be a Contact",
         lambda: wedge.stick_zone(LAZY, ONES, 0.1, 0.0, **STATE)),
        (TypeError, "P is lazy but not a Dask array",
         lambda: wedge.contact(delayed(len)([]), **LAW)),
        (TypeError, r"first.a is lazy.*\.to_dask_array",
         lambda: wedge.stick_zone(HERE._replace(a=delayed(len)([])), HERE, 0.1, 0.0, **STATE)),
    ],
)  # fmt: skip
def test_what_is_refused_at_the_call(
    kind: type[Exception], words: str, call: Callable[[], Any]
) -> None:
    with pytest.raises(kind, match=words):
        call()


# ------------------------------------------------------------------ the page that tells of it

PAGE = Path(__file__).parents[2] / "docs" / "arrays.md"


def test_the_page_shows_what_happens() -> None:
    failed, attempted = doctest.testfile(str(PAGE), module_relative=False)
    assert (failed, attempted) == (0, 10)
    links = re.findall(r"\]\(([^)#:]+)\)", PAGE.read_text())
    assert links
    assert all((PAGE.parent / link).exists() for link in links)
