"""Large arrays are computed in blocks and pieces; what comes out is what a whole one gives."""

import subprocess
import sys
import tracemalloc
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from generated import _arrays, _logarithm, flat_rounded, hertz, wedge
from generated._types import Contact, Edges

LAW = {"f": 0.5, "E_star": 1.0, "phi": 0.125}


def cycles(count: int) -> tuple[Contact, Any, Any]:
    """Contacts of a wedge, shear from half the friction to twice it, tension of both signs."""
    a, c, part, over = np.random.default_rng(3).uniform(0.5, 1.5, (4, count))
    load = wedge.load(a, c, E_star=1.0, phi=0.125)
    return Contact(a, c, 0 * a), part * load * 0.7, 0.6 * (over - 1)


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_arrays, "PIECE", 7)
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 14 * 90)  # numbers of 14 elements of the laborious


def test_pieces_of_a_cycle_make_the_whole(small: None, monkeypatch: pytest.MonkeyPatch) -> None:
    here, shear, tension = cycles(40)
    pieces = wedge.stick_zone(here, here, shear, tension, **LAW)
    monkeypatch.setattr(_arrays, "PIECE", 1000)
    whole = wedge.stick_zone(here, here, shear, tension, **LAW)
    assert len(set(whole.regime)) > 2
    assert pieces.regime.dtype == whole.regime.dtype
    assert_array_equal(pieces.regime, whole.regime)
    assert_allclose(pieces.m, whole.m, rtol=1e-12)
    assert_allclose(pieces.n, whole.n, rtol=1e-12)


def test_pieces_broadcast_as_whole_arrays_do(small: None) -> None:
    a, dQ = np.linspace(0.5, 1.5, 9)[:, None], np.linspace(0.001, 0.02, 11)
    found = wedge.slip_zones(a, 1.0, dQ, 0.01, **LAW, order=2)
    assert found.left.shape == (9, 11)
    for i, j in ((0, 0), (3, 10), (8, 5)):
        alone = wedge.slip_zones(a[i, 0], 1.0, dQ[j], 0.01, **LAW, order=2)
        assert_allclose((found.left[i, j], found.right[i, j]), alone, rtol=1e-12)


def test_options_reach_every_piece(small: None) -> None:
    here, shear, tension = cycles(30)
    third = wedge.slip_zones(here.a, here.c, shear, tension, **LAW, order=3)
    first = wedge.slip_zones(here.a, here.c, shear, tension, **LAW)
    both = np.isfinite(first.left) & np.isfinite(third.left)
    assert np.count_nonzero(both) > 5
    assert np.all(first.left[both] != third.left[both])
    with pytest.raises(ValueError, match="order must be 1, 2 or 3; got 4"):
        wedge.slip_zones(here.a, here.c, shear, tension, **LAW, order=4)


def test_what_is_wrong_is_told_of_the_whole_not_of_a_piece(small: None) -> None:
    a = np.linspace(0.5, 1.5, 30)
    with pytest.raises(ValueError, match=r"a \(30,\), dQ \(29,\)"):
        wedge.slip_zones(a, 1.0, a[1:], 0.0, **LAW)
    with pytest.raises(TypeError, match="first must be a Contact"):
        wedge.stick_zone(a, a, a, 0.0, **LAW)


@pytest.mark.parametrize("count", [1, 13, 14, 15, 21, 22, 50])
def test_blocks_make_the_whole(small: None, monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    x, a, c = np.random.default_rng(count).uniform(1.0, 3.0, (3, count))
    law = {"E_star": 1.0, "R": 1.0, "b": 0.5}
    blocks = flat_rounded.pressure(x - 2, a, c, **law)
    monkeypatch.setattr(_arrays, "RESIDENT", 1000 * 90)
    assert_allclose(blocks, flat_rounded.pressure(x - 2, a, c, **law), rtol=1e-14)


@pytest.mark.parametrize("count", [1, 13, 14, 15, 50])
def test_what_is_scaled_at_last_is_the_same_in_blocks(
    monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    """Where all contacts exist and where some or none do; of numbers, rows and both."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 20)
    x, a = np.random.default_rng(count).uniform(-1.0, 1.0, (2, count))
    for given in ((x, 1.5, 1.0), (x, -1.5, 1.0), (x, a, 1.0), (x, 2 + a, 1.0), (x[:, None], a, 1)):
        found = wedge.pressure(*given, E_star=1.0, phi=0.125)
        alone = [wedge.pressure(*one, E_star=1.0, phi=0.125) for one in np.broadcast(*given)]
        assert found.shape == np.broadcast(*given).shape
        assert_array_equal(found.ravel(), alone)
        assert np.isnan(found).any() == (np.min(given[1]) <= 0)


def test_what_is_scaled_at_last_is_computed_where_the_whole_result_lies(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its own memory keeps what was there, and a whole array's is the result."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 20)
    used: list[Any] = []

    @_arrays.elementwise(arrays=1)
    def thrice(x: Any, a: Any) -> Any:
        used.append(a + x)
        return _arrays.scaled_at_last(used[-1], np.float64(3.0))

    x = np.arange(21.0)
    assert_array_equal(thrice(x, 1.0), 3 * (x + 1))
    assert_array_equal(np.concatenate(used), x + 1)
    assert thrice(x[:7], 1.0) is used[-1]


def test_what_is_scaled_lies_where_it_lay() -> None:
    held = np.arange(5.0)
    assert _arrays.scaled(held, np.float64(2.0)) is held
    assert_array_equal(held, 2 * np.arange(5.0))


@pytest.fixture
def lengths(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many elements formulas of a wedge have computed at once, call by call."""
    seen: list[int] = []
    real = wedge.only_where

    def only_where(exists: Any, *values: Any) -> Any:
        seen.append(np.size(exists))
        return real(exists, *values)

    monkeypatch.setattr(wedge, "only_where", only_where)
    return seen


@pytest.mark.parametrize("varying", [False, True])
def test_an_array_is_cut_where_the_heap_does_not_hold_all(
    monkeypatch: pytest.MonkeyPatch, lengths: list[int], varying: bool
) -> None:
    """load holds three arrays: a + c, a c and its root; an array of constants is one more."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 120)
    most = 30 if varying else 40
    for count in (most, most + 1):
        a, slope = np.linspace(1, 2, count), np.full(count, 0.1) if varying else 0.1
        wedge.load(a, a, E_star=1.0, phi=slope)
    assert lengths[0] == most
    assert max(lengths[1:]) <= 7
    assert sum(lengths[1:]) == most + 1


def test_nothing_is_cut_where_an_argument_alone_leaves_only_results(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 10)
    seen: list[int] = []

    @_arrays.elementwise(arrays=4, bare=("dQ",))
    def both(a: Any, dQ: Any, *, b: Any) -> Edges:
        found = Edges(dQ * a, dQ * b)
        seen.append(max(np.size(v) for v in found))
        return found

    array = np.linspace(1, 2, 50)
    for a, dQ, b, cut in (
        *((1.0, array, 2.0, False), (array, 1.0, 2.0, True), (1.0, 1.0, array, True)),
        *((array, array, 2.0, True), (1.0, array, array, True), (array[:, None], array, 2.0, True)),
        *((1.0, array.reshape(5, 10), 2.0, False), (1.0, array.astype(np.float32), 2.0, True)),
    ):
        seen.clear()
        found = both(a, dQ, b=b)
        assert_array_equal(found.left, np.broadcast_to(dQ * a, found.left.shape))
        assert (max(seen) < array.size) == cut


@pytest.mark.parametrize(("arrays", "block"), [(20, 7), (21, 10)])
def test_blocks_hold_half_of_the_heap_where_no_cache_holds_them(
    monkeypatch: pytest.MonkeyPatch, arrays: int, block: int
) -> None:
    """Of 420 numbers, 21 arrays of ten; of twenty, which a cache may hold, blocks of 7."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 420)
    seen: list[int] = []

    @_arrays.elementwise(arrays=arrays)
    def twice(a: Any) -> Any:
        seen.append(a.size)
        return 2 * a

    for count in (20, 22, 10 * block):
        a = np.linspace(1, 2, count)
        assert_array_equal(twice(a), 2 * a)
    assert seen[0] == 20
    assert max(seen[1:]) == block


@pytest.mark.parametrize(("arrays", "whole"), [(20, (21, 21)), (21, (40, 20))])
def test_many_arrays_count_as_the_arguments_vary(
    monkeypatch: pytest.MonkeyPatch, arrays: int, whole: tuple[int, int]
) -> None:
    """Of 420 numbers 21 arrays of 40, if one of two arguments varies; 20 arrays in any case."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 420)
    seen: list[int] = []

    @_arrays.elementwise(arrays=arrays)
    def product(a: Any, c: Any) -> Any:
        seen.append(a.size)
        return a * c

    for varying, count in enumerate(whole, start=1):
        for longer in (0, 1):
            a = np.linspace(1, 2, count + longer)
            c = a if varying == 2 else 2.0
            seen.clear()
            assert_array_equal(product(a, c), a * c)
            assert (len(seen) == 1) == (not longer)


@pytest.mark.parametrize("varying", [1, 2])
def test_several_results_are_not_counted_and_the_rest_as_the_arguments_vary(
    monkeypatch: pytest.MonkeyPatch, lengths: list[int], varying: int
) -> None:
    """K_N holds four arrays, of which two are results: a + c, what scales, left and right."""
    monkeypatch.setattr(_arrays, "BLOCK", 7)
    monkeypatch.setattr(_arrays, "RESIDENT", 120)
    most = 120 // varying
    for count in (most, most + 1):
        a = np.linspace(1, 2, count)
        wedge.K_N(a, a if varying == 2 else 1.0, E_star=1.0, phi=0.1)
    assert lengths[0] == most
    assert max(lengths[1:]) <= 12  # a tenth of RESIDENT for each result, over four
    assert sum(lengths[1:]) == most + 1


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 0, 2)])
def test_blocks_follow_the_layout_in_memory(
    monkeypatch: pytest.MonkeyPatch, order: tuple[int, ...]
) -> None:
    """Blocks lie in one piece, and the result is laid out as the argument is, as a whole one is."""
    x = np.random.default_rng(1).uniform(-1, 1, (6, 5, 4)).transpose(order)
    law = {"a": 0.8, "c": 0.7, "E_star": 1.0, "phi": 0.1}
    whole, seen = wedge.pressure(x, **law), []

    def kink_logarithm(left: Any, right: Any, offset: Any) -> Any:
        seen.append((offset.size, offset.flags.forc))
        return _arrays.kink_logarithm(left, right, offset)

    monkeypatch.setattr(wedge, "kink_logarithm", kink_logarithm)
    monkeypatch.setattr(_arrays, "BLOCK", 20)
    monkeypatch.setattr(_arrays, "RESIDENT", 0)
    cut = wedge.pressure(x, **law)
    assert_array_equal(cut, whole)
    assert cut.strides == whole.strides == x.strides
    assert seen == [(20, True)] * 6
    column = np.full((x.shape[1], 1), 0.5)
    assert wedge.K_N(x**2, column, E_star=1.0, phi=0.1).left.shape == x.shape


def test_other_types_become_float64_block_by_block(
    monkeypatch: pytest.MonkeyPatch, lengths: list[int]
) -> None:
    a = np.linspace(1, 2, 50)
    for kind in (np.float32, np.int64, ">f8", np.float16):
        given = a.astype(kind)
        whole = wedge.load(given, given, E_star=1.0, phi=0.1)
        with monkeypatch.context() as cut:
            cut.setattr(_arrays, "BLOCK", 7)
            cut.setattr(_arrays, "RESIDENT", 0)
            blocks = wedge.load(given, given, E_star=1.0, phi=0.1)
            none = wedge.load(given[:0], given[:0], E_star=1.0, phi=0.1)
        assert_array_equal(blocks, whole)
        assert blocks.dtype == whole.dtype == none.dtype == np.float64
        assert none.shape == (0,)
    assert max(lengths[1:10]) <= 7


@pytest.mark.parametrize(("count", "longest"), [(1_240_000, 41_333), (10**7, 122_333)])
def test_blocks_hold_a_tenth_of_the_results_and_of_the_heap(
    lengths: list[int], count: int, longest: int
) -> None:
    """Of a load, 3 n numbers in a block of n."""
    a = np.broadcast_to(np.float64(1.5), (count,))
    wedge.load(a, 1.25, E_star=1.0, phi=0.1)
    assert len(lengths) > 1
    assert 0.9 * longest < max(lengths) <= longest
    assert 30 * max(lengths) <= min(count, _arrays.RESIDENT)


def test_no_block_is_longer_than_allowed() -> None:
    for shape in ((1,), (100,), (7, 15), (3, 4, 12), (4, 12), (5, 7), (30, 1), (2, 3, 100)):
        seen = np.zeros(shape)
        for index in _arrays._blocks(shape, 16):
            seen[index] += 1
            assert seen[index].size <= 16
        assert_array_equal(seen, 1)


def test_a_cycle_holds_little_beside_its_result() -> None:
    count = 400_000
    here, shear, tension = cycles(count)
    tracemalloc.start()
    found = wedge.slip_zones(here.a, here.c, shear, tension, **LAW)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 1.8 * (found.left.nbytes + found.right.nbytes)


@pytest.mark.parametrize("function", ["maximum", "minimum", "fmax"])
def test_the_larger_and_the_smaller_are_those_of_numpy(function: str) -> None:
    values = [-1.0, 0.0, 2.0, np.nan, np.inf, -np.inf]
    ours, its = getattr(_arrays, function), getattr(np, function)
    long = np.resize(values, 5000)
    for v in map(np.float64, values):
        for w in (*map(np.float64, values), *values):
            assert_array_equal(ours(v, w), its(v, w))
            assert type(ours(v, w)) is np.float64
        assert_array_equal(ours(long, v), its(long, v))
        assert_array_equal(ours(v, long.reshape(50, 100)), its(v, long.reshape(50, 100)))
        assert_array_equal(ours(long[:6], v), its(long[:6], v))


@pytest.mark.parametrize("count", [1, 4, 5000])
def test_a_logarithm_of_a_quotient_beyond_float64(count: int) -> None:
    """u = v = w/2 give log(1 + w/d): log(1 + 1e75/1e-250) = 325 log 10, and so on."""
    with np.errstate(all="ignore"):
        both, below = np.array([1e75, 1.0, 1.0, 0.0]), np.array([1e-250, 1.0, 0.0, 1.0])
        half = np.resize(both / 2, count)
        found = _arrays.kink_logarithm(half, half.copy(), np.resize(below, count))
        alone = _arrays.kink_logarithm(*map(np.float64, (5e74, 5e74, 1e-250)))
    wanted = [325 * np.log(10), np.log(2), np.inf, 0]
    assert_allclose(found, np.resize(wanted, count), rtol=1e-15)
    assert_allclose(alone, 325 * np.log(10), rtol=1e-15)
    assert type(alone) is np.float64


@pytest.mark.parametrize(
    ("ways", "slow"),
    [
        ({"current": "baseline(X86_V2)", "available": "X86_V4 baseline(X86_V2)"}, True),
        ({"current": "X86_V4", "available": "X86_V4 baseline(X86_V2)"}, False),
        ({"current": "baseline(NEON)", "available": "baseline(NEON)"}, False),
        ({}, False),
    ],
)
def test_the_table_serves_where_numpy_knows_a_better_way_for_others(
    monkeypatch: pytest.MonkeyPatch, ways: dict[str, str], slow: bool
) -> None:
    """Elsewhere log1p is the system's, as good as any, or as quick as log."""
    told = {"log1p": {"dd": ways}} if ways else {}
    monkeypatch.setattr(_logarithm, "opt_func_info", lambda **_: told)
    assert _logarithm._log1p_is_slow() == slow


@pytest.fixture(params=[True, False], ids=["table", "NumPy"])
def table(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """log1p takes the table, as without AVX-512, or NumPy's own; nothing is told of infinity."""
    monkeypatch.setattr(_logarithm, "BY_TABLE", request.param)
    with np.errstate(all="ignore"):
        yield


def test_log1p_is_right_to_the_last_digit_both_ways(table: None) -> None:
    """At 1e-17 it is its argument, at 1e17 log(1e17) + 1e-17; of mpmath in between.

    1.1 units: half of one in the table, half in the last sum, hundredths in the steps before; the
    system's own logarithm is in the table where long double has no more digits.
    """
    units = 1.1 if np.finfo(np.longdouble).nmant > np.finfo(float).nmant else 1.3
    rng = np.random.default_rng(3)
    wide, near = np.linspace(-1074, 1023, 4000), np.linspace(-12, 12, 8000)
    given = rng.permutation(np.exp2(np.append(wide, near)))
    given[:4] = 0.0, 5e-324, 1.0, 1.7e308
    with mp.workdps(30):
        exact = [mp.log1p(mp.mpf(v)) for v in given.tolist()]
        found = _logarithm.log1p(given.copy())
        off = [float(abs(mp.mpf(v) - e)) for v, e in zip(found.tolist(), exact, strict=True)]
    assert np.all(off <= units * np.spacing(np.array(exact, dtype=float)))
    assert found[0] == 0


def test_log1p_gives_the_same_bits_alone_and_among_others(table: None) -> None:
    """Beside numbers that stand in no table, too."""
    given = np.exp2(np.random.default_rng(4).uniform(-1074, 63.9, 600))
    given[:4] = 0.0, 5e-324, 2.0**-1022, 1.0
    found = _logarithm.log1p(given.copy())
    assert_array_equal(found, [_logarithm.log1p(v) for v in given.tolist()])
    assert_array_equal(found, [_logarithm.log1p(given[i : i + 1])[0] for i in range(600)])
    for odd in (np.inf, np.nan, -np.nan, -0.0, 2.0**64, 1e308):
        assert_array_equal(_logarithm.log1p(np.append(given, odd))[:-1], found)


@pytest.mark.parametrize("odd", [np.inf, np.nan, -np.nan, -0.0, 2.0**64, 1e308])
def test_what_stands_in_no_table_has_its_logarithm_all_the_same(table: None, odd: float) -> None:
    wanted = odd if odd == 0 else np.log(odd)  # one is lost beside 2**64
    for found in (_logarithm.log1p(np.float64(odd)), _logarithm.log1p(np.array([1.0, odd]))[1]):
        assert type(found) is np.float64
        assert_allclose(found, wanted, rtol=2**-52)


def test_log1p_uses_up_what_it_is_given_and_nothing_else(table: None) -> None:
    given = np.geomspace(1e-9, 1e9, 180)
    found = _logarithm.log1p(given)
    assert_array_equal(given, np.geomspace(1e-9, 1e9, 180))
    for odd in ([], [np.inf, np.nan, -0.0]):
        out, free = np.empty((2, 180 + len(odd)))
        assert _logarithm.log1p(np.append(given, odd), out, free) is out
        assert_array_equal(out, [*found, *map(abs, odd)])
    square = given.reshape(10, 18)
    assert_array_equal(_logarithm.log1p(square), found.reshape(10, 18))
    assert_array_equal(_logarithm.log1p(square.T), found.reshape(10, 18).T)
    assert_array_equal(_logarithm.log1p(given[::-2]), found[::-2])


def test_a_logarithm_of_a_kink_is_zero_outside_and_takes_what_broadcasts() -> None:
    """sqrt(1 4) + min(1, 4) = 3: log(1 + 3/2); the distance stays as it is."""

    def found(right: Any, distance: Any) -> Any:
        left = np.array([1.0, -1.0, 0.0])  # used up, as the right one is
        with np.errstate(all="ignore"):
            return _arrays.kink_logarithm(left, right.copy(), distance)

    row, column = np.full(3, 2.0), np.array([[2.0], [3.0]])
    for right in (np.full(3, 4.0), np.float64(4)):
        for distance in (np.float64(2), row):
            assert_allclose(found(right, distance), [np.log(2.5), 0, 0], rtol=1e-15)
        grid = [[np.log(2.5), 0, 0], [np.log(2), 0, 0]]
        assert_allclose(found(right, column), grid, rtol=1e-15)
    assert_array_equal(row, 2)
    assert_array_equal(column, [[2], [3]])


@pytest.mark.parametrize("body", [hertz, wedge])
def test_no_argument_is_changed(body: ModuleType) -> None:
    """Though a pressure is computed in the memory of what is wanted no more."""
    own = {"R": np.full(50, 2.0)} if body is hertz else {"phi": np.full(50, 0.1)}
    given = [np.linspace(-1, 1, 50), np.full(50, 1.5), np.full(50, 1.25)]
    modulus = np.full(50, 3.0)
    kept = [v.copy() for v in (*given, modulus, *own.values())]
    body.pressure(*given, E_star=modulus, **own)
    body.pressure(*given, E_star=3.0, **{name: v[0] for name, v in own.items()})
    for value, before in zip((*given, modulus, *own.values()), kept, strict=True):
        assert_array_equal(value, before)


def test_hertz_needs_none_of_it() -> None:
    """One number and a million go the same way, to the last bit."""
    a = np.linspace(1, 2, 100_000)
    found = hertz.load(a, 1.0, E_star=1.0, R=1.0)
    assert_array_equal(found[::9999], [hertz.load(v, 1.0, E_star=1.0, R=1.0) for v in a[::9999]])


FRESH = """
import resource
import mpmath as mp
import numpy as np
from generated import wedge

P = np.linspace(1.0, 2.0, {count})
faults = []
for _ in range(12):
    wedge.contact(P, 0.1, E_star=1.0, phi=0.125)
    faults.append(resource.getrusage(resource.RUSAGE_SELF).ru_minflt)
print(faults[-1] - faults[1])
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="counts pages as Linux does")
@pytest.mark.parametrize("count", [6_000, 13_000, 26_000, 200_000])
def test_temporaries_take_no_new_pages_call_by_call(count: int) -> None:
    """A page is 512 numbers: ten calls that asked for theirs anew would take hundreds."""
    code = [sys.executable, "-c", FRESH.format(count=count)]
    told = subprocess.run(code, capture_output=True, text=True, check=True)
    assert int(told.stdout) < 10 * count / 512
