"""Dask arrays in, Dask arrays out: lazily, chunk by chunk, the numbers of NumPy arrays.

Everything here runs in this process; tests/generated/test_cluster.py has the distributed scheduler.
"""

import doctest
import importlib
import inspect
import pickle
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import dask
import dask.array as da
import numpy as np
import pytest
from dask.delayed import delayed
from numpy.testing import assert_array_equal

from generated import _arrays, flat_rounded, hertz, hyperbola, wedge
from generated.runtime.types import Contact
from tests.generated.test_library import OWN

E_STAR, F = 1.25, 0.5
CLOSED = ("wedge", "hertz", "unequal_wedge")
SOME = (*CLOSED, "flat_rounded", "hyperbola")
"""Closed formulas with a corner and without; Newton's method and mended formulas; quadrature."""

LENGTH, CHUNK = 7, 3
INSTANTS = 5


@pytest.fixture(autouse=True)
def in_this_thread() -> Iterator[None]:
    with dask.config.set(scheduler="synchronous"):
        yield


def module(body: str) -> ModuleType:
    return importlib.import_module(f"generated.{body}")


def functions(body: str) -> list[str]:
    of = module(body)
    return [name for name in of.__all__ if not inspect.isclass(getattr(of, name))]


EVERY = [(body, name) for body in sorted(OWN) for name in functions(body)]
LONG = ("closing_tension", "shear", "shear_change", "slip_range")
EACH = [(body, name) for body, name in EVERY if body in SOME]


def marked(cases: list[tuple[str, str]], left_out: tuple[str, ...] = ()) -> list[Any]:
    """Those of closed bodies are quick; of the others, some may be left out."""
    quick = [case for case in cases if case[0] in CLOSED]
    slow = [case for case in cases if case not in quick and case[1] not in left_out]
    return [*quick, *(pytest.param(*case, marks=pytest.mark.slow) for case in slow)]


def states(body: str, length: int = LENGTH) -> dict[str, Any]:
    """Values for every argument: contacts of this body, cycles of moderate tension."""
    of, own = module(body), OWN[body]
    rng = np.random.default_rng(3)
    by = 0.25 if body == "circular_arc" else 1.0
    a, c = by * (1.25 + 0.25 * rng.uniform(size=(2, length)))
    P, M = of.load(a, c, E_star=E_STAR, **own), of.moment(a, c, E_star=E_STAR, **own)
    dQ = 0.25 * F * P
    here = Contact(a, c, of.tilt(a, c, **own))
    return {
        **{"a": a, "c": c, "P": P, "M": M, "alpha": here.alpha, "x": 0.3 * (c - a) + 0.1 * a},
        **{"first": here, "second": here, "dQ": dQ, "dsigma": 4 * dQ / (np.pi * (a + c))},
        **{"contact": here, "Q": 0.75 * dQ, "sigma": 3 * dQ / (np.pi * (a + c))},
        **{"dP": 0.1 * P, "dM": 0.05 * M, "da": 0.0, "dc": 0.0},
        **{"f": np.full(length, F), "E_star": np.full(length, E_STAR)},
        **{name: np.full(length, value) for name, value in own.items()},
    }


def given_to(body: str, name: str) -> dict[str, Any]:
    held = states(body)
    if name == "march":
        turn = np.array([0.0, 0.5, 1.0, 0.5, 0.0])
        cycles = {k: np.repeat(held[k][:, None], INSTANTS, axis=1) for k in ("P", "M")}
        held |= {**cycles, "Q": held["dQ"][:, None] * turn, "sigma": 0.0}
        held |= {k: v[:, None] for k, v in held.items() if k in ("f", "E_star", *OWN[body])}
    taken = inspect.signature(getattr(module(body), name)).parameters
    return {k: v for k, v in held.items() if k in taken}


def lazy(value: Any, chunk: Any = CHUNK) -> Any:
    """The same as a Dask array; a Contact field by field; time in one chunk."""
    if isinstance(value, Contact):
        return Contact(*(lazy(v, chunk) for v in value))
    value = np.asarray(value)
    chunks = (*[chunk] * min(1, value.ndim), *value.shape[1:])
    return da.from_array(value, chunks=chunks)


def rows(value: Any, part: slice) -> Any:
    if isinstance(value, Contact):
        return Contact(*(rows(v, part) for v in value))
    return value[part] if np.ndim(value) else value


def fields(result: Any) -> tuple[Any, ...]:
    return result if isinstance(result, tuple) else (result,)


def parts() -> Iterator[slice]:
    return (slice(i, i + CHUNK) for i in range(0, LENGTH, CHUNK))


# ------------------------------------------------------------------ the same numbers


@pytest.mark.enough("wedge-*", "rounded_wedge-*", "power-*")
@pytest.mark.parametrize(("body", "name"), marked(EVERY))
def test_every_function_gives_what_numpy_gives_chunk_by_chunk(body: str, name: str) -> None:
    """To the last bit, of the same kind, shape and dtype, in the chunks that were given."""
    function, given = getattr(module(body), name), given_to(body, name)
    found = function(**{k: lazy(v) for k, v in given.items()})
    whole = function(**given)
    pieces = [fields(function(**{k: rows(v, part) for k, v in given.items()})) for part in parts()]
    assert type(found) is (type(whole) if isinstance(whole, tuple) else da.Array)
    computed = dask.compute(*fields(found))
    for i, (field, value, known) in enumerate(
        zip(fields(found), computed, fields(whole), strict=True)
    ):
        assert isinstance(field, da.Array)
        assert field.dtype == value.dtype == known.dtype
        assert field.shape == value.shape == known.shape
        assert field.chunks[0] == (3, 3, 1)
        assert_array_equal(value, np.concatenate([piece[i] for piece in pieces]))
    if name in ("contact", "load", "stick_zone", "march", "slip_zones"):
        assert all(np.all(np.isfinite(value)) for value in computed)


@pytest.mark.parametrize("body", CLOSED)
def test_closed_formulas_do_not_depend_on_the_chunks(body: str) -> None:
    of, given = module(body), given_to(body, "contact")
    for chunk in (1, 2, 7):
        for one, other in zip(
            of.contact(**{k: lazy(v, chunk) for k, v in given.items()}),
            of.contact(**given),
            strict=True,
        ):
            assert_array_equal(one.compute(), other)


def test_the_regime_is_a_whole_number() -> None:
    zone = wedge.stick_zone(**{k: lazy(v) for k, v in given_to("wedge", "stick_zone").items()})
    assert zone.regime.dtype == np.int64
    assert {wedge.Regime(code) for code in zone.regime.compute()} == {wedge.Regime.MODERATE}


# ------------------------------------------------------------------ what may be mixed


@pytest.mark.enough("wedge-*", "flat_rounded-*")
@pytest.mark.slow
@pytest.mark.parametrize(("body", "name"), marked(EACH, left_out=LONG))
def test_one_lazy_argument_among_arrays_is_enough(body: str, name: str) -> None:
    function, given = getattr(module(body), name), given_to(body, name)
    whole = fields(function(**given))
    for argument, value in given.items():
        if np.ndim(value[0] if isinstance(value, Contact) else value) and name != "march":
            for one, other in zip(
                fields(function(**given | {argument: lazy(value)})), whole, strict=True
            ):
                assert one.chunks == ((3, 3, 1),), argument
                assert np.allclose(one.compute(), other, rtol=1e-9, atol=1e-14, equal_nan=True)


def test_numbers_arrays_and_constants_mix() -> None:
    x, a = np.linspace(-0.9, 0.9, 4), np.array([[1.0], [1.25], [1.5]])
    phi = np.array([[0.1], [0.2], [0.3]])
    found = wedge.pressure(
        da.from_array(x, chunks=2), a, 1.25, E_star=da.from_array(1.5), phi=da.from_array(phi)
    )
    assert found.shape == (3, 4)
    assert found.chunks == ((3,), (2, 2))
    assert_array_equal(found.compute(), wedge.pressure(x, a, 1.25, E_star=1.5, phi=phi))


def test_axes_of_one_broadcast_against_chunks() -> None:
    tall, wide = np.linspace(1, 2, 5)[:, None], np.linspace(-0.5, 0.5, 4)[None, :]
    found = hertz.contact(
        da.from_array(tall, chunks=(2, 1)), da.from_array(wide, chunks=(1, 3)), E_star=1.0, R=2.0
    )
    whole = hertz.contact(tall, wide, E_star=1.0, R=2.0)
    assert found.a.chunks == ((2, 2, 1), (3, 1))
    for one, other in zip(found, whole, strict=True):
        assert_array_equal(one.compute(), other)


def test_chunks_that_differ_are_unified() -> None:
    P, M = np.linspace(1, 2, 10), np.linspace(-0.5, 0.5, 10)
    found = hertz.contact(da.from_array(P, chunks=4), da.from_array(M, chunks=5), E_star=1.0, R=2.0)
    assert found.a.chunks == ((4, 1, 3, 2),)
    assert_array_equal(found.a.compute(), hertz.contact(P, M, E_star=1.0, R=2.0).a)


def unknown(values: np.ndarray) -> Any:
    """Chunks whose lengths are not known: those above the middle."""
    whole = da.from_array(values, chunks=4)
    return whole[whole > 1.5]


def test_lengths_may_be_unknown() -> None:
    values = np.linspace(1, 2, 11)
    kept, lazily = values[values > 1.5], unknown(values)
    state = hyperbola.contact(lazily, 0.25, E_star=1.0, b=0.5, phi=0.25)
    assert np.isnan(state.a.shape[0])
    zone = hyperbola.stick_zone(state, state, 0.1 * lazily, 0.0, f=0.5, E_star=1.0, b=0.5, phi=0.25)
    known = hyperbola.contact(kept, 0.25, E_star=1.0, b=0.5, phi=0.25)
    other = hyperbola.stick_zone(known, known, 0.1 * kept, 0.0, f=0.5, E_star=1.0, b=0.5, phi=0.25)
    assert zone.m.compute() == pytest.approx(other.m, rel=1e-12)
    assert_array_equal(zone.regime.compute(), other.regime)


def test_a_length_that_is_unknown_does_not_meet_one_that_is_known() -> None:
    with pytest.raises(ValueError, match="compute_chunk_sizes"):
        wedge.contact(unknown(np.linspace(1, 2, 11)), np.ones(6), E_star=1.0, phi=0.25)


def test_no_axis_at_all() -> None:
    state = flat_rounded.contact(da.from_array(1.0), 0.1, E_star=1.0, R=1.0, b=0.5)
    assert all(v.shape == () and v.dtype == np.float64 for v in state)
    known = flat_rounded.contact(1.0, 0.1, E_star=1.0, R=1.0, b=0.5)
    assert dask.compute(*state) == tuple(known)


def test_no_elements_and_empty_chunks() -> None:
    some = da.from_array(np.linspace(1, 2, 4), chunks=((0, 2, 0, 2),))
    found = hyperbola.contact(some, 0.25, E_star=1.0, b=0.5, phi=0.25).a
    assert found.chunks == ((0, 2, 0, 2),)
    assert np.all(np.isfinite(found.compute()))
    assert hertz.load(da.ones(0), 1.0, E_star=1.0, R=1.0).compute().shape == (0,)


@pytest.mark.parametrize("dtype", [np.int8, np.float32, np.uint64, ">f8"])
def test_every_real_type_counts_as_float64(dtype: Any) -> None:
    a = np.array([100, 110, 120], dtype=dtype)
    found = wedge.load(da.from_array(a, chunks=2), 100, E_star=1.25, phi=0.25)
    assert found.dtype == np.float64
    assert_array_equal(found.compute(), wedge.load(a, 100, E_star=1.25, phi=0.25))


def test_what_is_masked_is_nan() -> None:
    a = da.ma.masked_greater(da.linspace(1, 2, 5, chunks=2), 1.6)
    found = wedge.load(a, 1.0, E_star=1.0, phi=0.25).compute()
    assert type(found) is np.ndarray
    assert_array_equal(np.isnan(found), [False, False, False, True, True])


def test_constants_that_are_none_give_nan_where_they_are() -> None:
    R = da.from_array(np.array([1.0, -1.0, 0.0, np.inf, 2.0]), chunks=2)
    found = hertz.load(1.0, 1.0, E_star=1.0, R=R).compute()
    assert_array_equal(np.isnan(found), [False, True, True, True, False])


def test_time_may_be_cut_along_every_other_axis() -> None:
    given = given_to("wedge", "march")
    whole = wedge.march(**given)
    cycle = wedge.march(**given | {"Q": lazy(given["Q"])})
    assert cycle.m.chunks == ((3, 3, 1), (INSTANTS,))
    assert cycle.left.dtype == cycle.regime.dtype == np.int64
    for one, other in zip(dask.compute(*cycle), whole, strict=True):
        assert_array_equal(one, other)


def test_one_cycle_may_be_lazy() -> None:
    Q = np.array([0.0, 0.1, 0.2, 0.1])
    law = {"f": 0.5, "E_star": 1.0, "R": 1.0}
    cycle = hertz.march(1.0, 0.0, da.from_array(Q, chunks=4), 0.0, **law)
    assert_array_equal(cycle.m.compute(), hertz.march(1.0, 0.0, Q, 0.0, **law).m)


def test_instants_may_be_unknown_in_number() -> None:
    Q = np.array([0.0, 0.1, 0.2, 0.1, 9.0])
    lazily = da.from_array(Q, chunks=5)
    law = {"f": 0.5, "E_star": 1.0, "R": 1.0}
    for P in (1.0, np.ones(1), np.ones((3, 1))):
        cycle = hertz.march(P, 0.0, lazily[lazily < 1], 0.0, **law)
        assert_array_equal(cycle.m.compute(), hertz.march(P, 0.0, Q[:4], 0.0, **law).m)


# ------------------------------------------------------------------ lazily, and each chunk once


class Asked(Exception):
    """A chunk was computed."""


def raising(block: Any) -> Any:
    raise Asked


@pytest.mark.parametrize(("body", "name"), EACH)
def test_nothing_is_computed_by_the_call(body: str, name: str) -> None:
    function, given = getattr(module(body), name), given_to(body, name)

    def trapped(value: Any) -> Any:
        if isinstance(value, Contact):
            return Contact(*map(trapped, value))
        return lazy(value).map_blocks(raising, meta=np.empty((0,) * np.ndim(value)))

    for found in fields(function(**{k: trapped(v) for k, v in given.items()})):
        with pytest.raises(Asked):
            found.compute()


class Spy:
    """Stands for what computes a function's chunks; keeps the sizes that it sees."""

    def __init__(self, real: Callable[..., Any]) -> None:
        self.real = real
        self.sizes: list[int] = []

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        seen = [v.size for v in (*args, *kwargs.values()) if isinstance(v, np.ndarray)]
        if 0 not in seen:  # no elements: how kinds and dtypes are found at the call
            self.sizes.append(max(seen))
        return self.real(*args, **kwargs)


SPIED = {
    "stick_zone": (wedge, "stick_zone_of"),
    "slip_zones": (wedge, "slip_zones_of"),
    "tension_threshold": (wedge, "tension_threshold_of"),
    "contact": (hyperbola, "contact_under"),
    "contact_at_tilt": (flat_rounded, "contact_at"),
    "load": (hyperbola, "state_of"),
}
"""What computes each of these, by its name in the body's module."""


@pytest.mark.parametrize("name", SPIED)
def test_each_chunk_is_computed_once_for_all_fields(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And no more than a chunk at a time."""
    of, inner = SPIED[name]
    given = given_to(of.__name__.rpartition(".")[2], name)
    spy = Spy(getattr(of, inner))
    monkeypatch.setattr(of, inner, spy)
    found = fields(getattr(of, name)(**{k: lazy(v) for k, v in given.items()}))
    assert spy.sizes == []
    dask.compute(*found)
    assert sorted(spy.sizes) == [1, 3, 3]
    for asked in (found[:1], [sum(v.sum() for v in found)]):  # one alone, and all in one
        spy.sizes.clear()
        dask.compute(*asked)
        assert sorted(spy.sizes) == [1, 3, 3]


def test_from_loads_to_slip_each_chunk_is_computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    solve, zones = Spy(hyperbola.contact_under), Spy(hyperbola.stick_zone_of)
    monkeypatch.setattr(hyperbola, "contact_under", solve)
    monkeypatch.setattr(hyperbola, "stick_zone_of", zones)
    given = {k: lazy(v) for k, v in given_to("hyperbola", "contact").items()}
    state = hyperbola.contact(**given)
    own = {k: v for k, v in given.items() if k not in ("P", "M")}
    zone = hyperbola.stick_zone(state, state, 0.1 * given["P"], 0.0, f=F, **own)
    slip = [da.histogram(v, bins=4, range=(0, 2))[0] for v in (state.a - zone.m, state.c - zone.n)]
    dask.compute(*slip, zone.regime.max())
    assert sorted(solve.sizes) == sorted(zones.sizes) == [1, 3, 3]


def test_large_chunks_are_computed_in_the_blocks_of_numpy_arrays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sizes: list[int] = []
    real = wedge.only_where

    def only_where(exists: Any, *values: Any) -> Any:
        sizes.append(np.size(exists))
        return real(exists, *values)

    monkeypatch.setattr(wedge, "only_where", only_where)
    monkeypatch.setattr(_arrays, "RESIDENT", 0)
    count = 40 * _arrays.BLOCK
    a = np.linspace(1, 2, count)
    lazily = da.from_array(a, chunks=20 * _arrays.BLOCK)
    found = wedge.load(lazily, 1.25, E_star=1.0, phi=0.25)
    assert_array_equal(found.compute(), wedge.load(a, 1.25, E_star=1.0, phi=0.25))
    assert max(sizes) == _arrays.BLOCK


def test_the_same_call_has_the_same_name() -> None:
    """So that Dask shares what two results have in common."""
    P = da.linspace(1, 2, 6, chunks=2)
    one, two, other = (hertz.contact(P, M, E_star=1.0, R=1.0) for M in (0.1, 0.1, 0.2))
    assert one.a.name == two.a.name
    assert len({one.a.name, one.c.name, other.a.name}) == 3
    assert one.a.name.startswith("contact-a-")


def test_functions_are_pickled_by_name() -> None:
    for body, name in EVERY:
        function = getattr(module(body), name)
        text = pickle.dumps(function)
        assert pickle.loads(text) is function
        assert len(text) < 80


# ------------------------------------------------------------------ what is refused, at the call


def refused(kind: type[Exception], words: str, call: Callable[[], Any]) -> None:
    with pytest.raises(kind, match=words):
        call()


LAW: Mapping[str, Any] = {"E_star": 1.0, "phi": 0.25}


def test_shapes_that_do_not_broadcast_are_told_as_for_numpy_arrays() -> None:
    words = r"the arguments must broadcast to one shape; their shapes are P \(10,\), M \(9,\)"
    refused(ValueError, words, lambda: wedge.contact(da.ones(10), da.ones(9), **LAW))
    refused(ValueError, words, lambda: wedge.contact(da.ones(10), np.ones(9), **LAW))
    refused(ValueError, words, lambda: wedge.contact(np.ones(10), np.ones(9), **LAW))
    here, there = (Contact(da.ones(n), 1.0, 0.0) for n in (3, 4))
    words = r"shapes are first.a \(3,\), second.a \(4,\)"
    refused(ValueError, words, lambda: wedge.stick_zone(here, there, 0.1, 0.0, f=F, **LAW))


@pytest.mark.parametrize("dtype", [complex, object, "U3", bool, "M8[s]"])
def test_what_is_no_real_number_is_told(dtype: Any) -> None:
    wrong = da.from_array(np.array([1, 2, 3]).astype(dtype), chunks=2)
    words = "a must be a real number or an array of such; got Array dask.array"
    refused(TypeError, words, lambda: wedge.load(wrong, 1.0, **LAW))
    words = "dQ must be a real number or an array of such; got Array dask.array"
    here = Contact(1.0, 1.0, 0.0)
    refused(TypeError, words, lambda: wedge.stick_zone(here, here, wrong, 0.0, f=F, **LAW))


def test_what_is_lazy_and_no_array_is_not_computed() -> None:
    task = delayed(raising)(1.0)
    refused(TypeError, "P is lazy, but no Dask array", lambda: wedge.contact(task, **LAW))
    here = Contact(task, 1.0, 0.0)
    words = r"first.a is lazy.*\.to_dask_array"
    refused(TypeError, words, lambda: wedge.stick_zone(here, here, 0.1, 0.0, f=F, **LAW))


def test_chunks_along_time_are_refused() -> None:
    Q = da.ones((4, 10), chunks=(2, 5))
    words = r"the last axis of Q is time and must lie in one chunk.*\(5, 5\).*rechunk"
    refused(ValueError, words, lambda: wedge.march(1.0, 0.0, Q, 0.0, f=F, **LAW))
    constant = da.ones((4, 1), chunks=(2, 1))
    assert wedge.march(constant, 0.0, np.arange(3.0), 0.0, f=F, **LAW).m.shape == (4, 3)
    words = "a cycle has two instants or more"
    refused(ValueError, words, lambda: wedge.march(constant, 0.0, 0.0, 0.0, f=F, **LAW))


def test_what_else_is_refused_is_refused_at_the_call() -> None:
    a, here = da.ones(3), Contact(da.ones(3), 1.0, 0.0)
    refused(
        ValueError,
        "order must be 1, 2 or 3; got 7",
        lambda: wedge.slip_zones(a, 1.0, 0.1, 0.0, f=F, order=7, **LAW),
    )
    refused(
        TypeError,
        r"slip_zones\(\) got an unexpected keyword argument 'surplus'",
        lambda: wedge.slip_zones(a, 1.0, 0.1, 0.0, f=F, surplus=1, **LAW),
    )
    refused(
        TypeError,
        "second must be a Contact",
        lambda: wedge.stick_zone(here, a, 0.1, 0.0, f=F, **LAW),
    )


# ------------------------------------------------------------------ the page that tells of it

PAGE = Path(__file__).parents[2] / "docs" / "arrays.md"


def test_the_page_shows_what_happens() -> None:
    failed, attempted = doctest.testfile(str(PAGE), module_relative=False)
    assert (failed, attempted) == (0, 10)


def test_every_link_of_the_page_leads_somewhere() -> None:
    links = re.findall(r"\]\(([^)#:]+)\)", PAGE.read_text())
    assert len(links) >= 4
    assert all((PAGE.parent / link).exists() for link in links)


# ------------------------------------------------------------------ without Dask

ALONE = """
import sys
import numpy as np
from generated import wedge
here = wedge.contact(np.linspace(1, 2, 3), 0.1, E_star=1.0, phi=0.25)
wedge.stick_zone(here, here, 0.1, 0.0, f=0.5, E_star=1.0, phi=0.25)
assert not {name.partition('.')[0] for name in sys.modules} & {'dask', 'distributed'}
"""


def test_nothing_of_dask_is_loaded_without_it() -> None:
    subprocess.run([sys.executable, "-c", ALONE], check=True)
