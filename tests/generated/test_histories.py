"""Load histories of a generated module: Dask arrays, and a record with its rainflow cycles."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from generated import flat_sloped, hertz
from generated.runtime.types import Regime
from tests.generated.test_shear import over

da = pytest.importorskip("dask.array")

FRICTION = {"f": 0.5, "E_star": 115e9, "R": 0.05}
P = 1e6 * (1 + 0.1 * np.array([[0.0, 1.0, 0.0, -1.0], [0.0, 0.5, 0.0, -0.5], [0.0] * 4]))
Q = 1e5 * np.array([1.0, 0.5, -1.0, 0.5])
PLACES = 1e-3 * np.array([[0.2, 0.5], [-0.5, 0.7]])


@pytest.mark.parametrize(
    ("call", "x"), [(hertz.history, PLACES), (hertz.steady_cycle, None), (hertz.steady_cycle, 5e-4)]
)
def test_dask_arrays_chunk_by_chunk(call: Any, x: Any) -> None:
    given = {**FRICTION, "x": x, "tol": 8e-3}
    plain = call(P, 0.0, Q, 1e7, **given)
    lazy = call(da.from_array(P, chunks=(1, 4)), 0.0, da.from_array(Q), 1e7, **given)
    assert type(lazy) is type(plain)
    for name, here, there in zip(plain._fields, lazy, plain, strict=True):
        if there is None:
            assert here is None
            continue
        assert isinstance(here, da.Array), name
        assert (here.shape, here.dtype) == (there.shape, there.dtype), name
        assert_allclose(here.compute(scheduler="synchronous"), there, err_msg=name)


def test_what_cannot_be_lazy_is_refused_at_the_call() -> None:
    lazy = da.from_array(P, chunks=(3, 2))
    with pytest.raises(ValueError, match=r"P\.rechunk"):
        hertz.history(lazy, 0.0, Q, 0.0, **FRICTION)
    with pytest.raises(TypeError, match="x must be a number or a NumPy array"):
        hertz.history(P, 0.0, Q, 0.0, x=da.from_array(PLACES), **FRICTION)
    with pytest.raises(ValueError, match="broadcast"):
        hertz.steady_cycle(da.from_array(P), 0.0, Q[:3], 0.0, **FRICTION)


def test_friction_s_work_is_that_of_the_rainflow_cycles() -> None:
    """A record that begins at its largest load: each of its cycles takes two branches of its range,
    each half cycle that is left over takes one."""
    rainflow = pytest.importorskip("rainflow")
    record = np.random.default_rng(5).uniform(-0.7, 0.7, 60) * 0.5 * 1e6
    record[0] = 0.8 * 0.5 * 1e6
    told = hertz.history(1e6, 0.0, record, 100 * record, **FRICTION)
    assert np.all(told.regime == Regime.MODERATE)
    swings, counts = np.transpose(rainflow.count_cycles(record))
    ends = np.stack([swings / 2, -swings / 2], axis=-1)
    pairs = hertz.history(1e6, 0.0, ends, 100 * ends, **FRICTION)
    branches = np.diff(pairs.work, axis=-1)[:, 0]
    assert_allclose(told.work[-1] - told.work[0], 2 * counts @ branches, rtol=1e-9)


def test_exact_work_where_a_corner_slips() -> None:
    """int f p slip dx by another rule; the pressure is infinite at the corners at +-b."""
    loads, own = (0.5, 0.01, [0.2375], [0.2375]), {"E_star": 1.0, "phi": 0.8, "b": 0.9}
    told = flat_sloped.history(*loads, f=0.5, **own)
    assert told.regime[0] == Regime.MODERATE and told.error[0] == 0

    def rate(x: Any) -> Any:
        p = flat_sloped.pressure(x, told.a[0], told.c[0], **own)
        return 0.5 * p * flat_sloped.history(*loads, x=x, f=0.5, **own).slip[0]

    places = [-told.a[0], -0.9, -told.m[0], told.n[0], told.c[0]]
    assert places == sorted(places)
    work = sum(over(rate, *places[k : k + 2], kinks=()) for k in (0, 1, 3))
    assert_allclose(told.work[0], work, rtol=1e-7)
