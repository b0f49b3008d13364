"""A load case in Python's numbers has the bits of NumPy's, which answer what Python refuses."""

import importlib
import math
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from inspect import signature
from itertools import product
from typing import Any

import numpy as np
import pytest

from derive.codegen.contract import CONTRACT
from derive.library import library
from generated import _arrays, _logarithm, _plain, flat_rounded, hertz, rounded_wedge, wedge

SPECIAL = (0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 1e300, 5e-324, math.inf, -math.inf, math.nan)
SOLVED_OR_INTEGRATED = {"_BODY", "_state", "contact_at", "contact_under"}

Function = Callable[..., Any]


def bits(result: Any) -> list[str]:
    """Every number exactly, the sign of a zero, too."""
    values = result if isinstance(result, tuple) else (result,)
    return [float(value).hex() for value in values]


def explicit() -> Iterator[Any]:
    """Every formula of the library that is neither solved for nor integrated by a rule."""
    for body, function in product(library(), CONTRACT):
        made = getattr(importlib.import_module(f"generated.{body}"), function.name)
        if not SOLVED_OR_INTEGRATED & {*made.__wrapped__.__code__.co_names}:
            yield pytest.param(made, id=f"{body}.{function.name}")


EXPLICIT = [*explicit()]


def test_most_of_the_library_is_explicit() -> None:
    assert len(EXPLICIT) > 90


@pytest.mark.parametrize("function", EXPLICIT)
def test_the_bits_are_those_of_numpy(function: Function) -> None:
    """At ordinary numbers, at edges and kinks, and at all that is zero, endless or no number."""
    plainly, formula = _plain.in_plain_numbers(function.__wrapped__), function.__wrapped__
    assert plainly, "it is computed in NumPy's numbers, at twice the time"
    names = [*signature(function).parameters]
    rng = np.random.default_rng(5)
    answered = 0
    for _ in range(400):
        given = {n: float(v) for n, v in zip(names, rng.uniform(0.1, 3, len(names)), strict=True)}
        for name in names:
            kind = rng.integers(8)
            if kind == 0:
                given[name] = float(rng.choice(SPECIAL))
            elif kind == 1:
                given[name] *= -1
            elif kind == 2:
                given[name] = given[names[0]]
        with np.errstate(all="ignore"):
            wanted = formula(**{name: np.float64(v) for name, v in given.items()})
        try:
            found = plainly(**given)
        except _plain.REFUSALS:
            continue
        answered += 1
        assert bits(found) == bits(wanted), given
    assert answered > 100


@pytest.mark.parametrize("function", EXPLICIT)
def test_what_python_refuses_numpy_answers(function: Function) -> None:
    names = [*signature(function).parameters]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for special in set(SPECIAL) - {5e-324}:  # whose curvature 1/R leaves float64
            for name in names:
                given = dict.fromkeys(names, 1.5) | {name: special}
                number = function(**given)
                array = function(**given | {names[0]: np.array([given[names[0]]])})
                assert np.array_equal(np.isnan(np.ravel(number)), np.isnan(np.ravel(array)))


def test_python_refuses_what_is_left_to_numpy() -> None:
    """M/0, the root of what is negative, a quotient beyond float64."""
    refused = (
        (wedge.contact, {"P": 0.0, "M": 1.0, "E_star": 1.0, "phi": 0.1}),
        (wedge.K_N, {"a": -1.0, "c": 2.0, "E_star": 1.0, "phi": 0.1}),
        (wedge.pressure, {"x": 0.0, "a": 1.0, "c": 1.0, "E_star": 1.0, "phi": 0.1}),
        (wedge.pressure, {"x": 3.0, "a": 1.0, "c": 1.0, "E_star": 1.0, "phi": 0.1}),
    )
    for function, given in refused:
        plainly = _plain.in_plain_numbers(function.__wrapped__)
        assert plainly
        with pytest.raises(_plain.REFUSALS):
            plainly(**given)
    assert wedge.pressure(0.0, 1.0, 1.0, E_star=1.0, phi=0.1) == np.inf
    assert wedge.pressure(3.0, 1.0, 1.0, E_star=1.0, phi=0.1) == 0


@pytest.mark.parametrize("function", [hertz.contact, hertz.pressure, flat_rounded.L_N])
def test_numbers_of_both_kinds_give_numpy_s(function: Function) -> None:
    names = [*signature(function).parameters]
    for kinds in product((float, np.float64), repeat=len(names)):
        found = function(**{n: kind(1.5) for n, kind in zip(names, kinds, strict=True)})
        values = found if isinstance(found, tuple) else (found,)
        assert {type(value) for value in values} == {np.float64}
        assert bits(found) == bits(function(**dict.fromkeys(names, 1.5)))


# ------------------------------------------------------------------ counterparts, one by one


@pytest.mark.parametrize("name", ["fmax", "maximum", "minimum"])
def test_the_larger_and_the_smaller(name: str) -> None:
    for first, second in product(SPECIAL, repeat=2):
        ours = getattr(_arrays, name)(np.float64(first), second)
        assert float(ours).hex() == float(_plain._COUNTERPARTS[name](first, second)).hex()
        arrays = getattr(np, name)([first], [second])
        assert type(ours) is np.float64
        assert float(ours) == arrays[0] or (np.isnan(ours) and np.isnan(arrays[0]))


@pytest.mark.parametrize("name", [n for n, v in vars(_plain._NUMPY).items() if callable(v)])
def test_functions_are_numpy_s_or_refuse(name: str) -> None:
    ours, its = getattr(_plain._NUMPY, name), getattr(np, name)
    many = 2 if name == "arctan2" else 1
    answered = 0
    for values in product((*SPECIAL, 2.0, 710.0, -0.3, 0.7, 1e5), repeat=many):
        with np.errstate(all="ignore"):
            wanted = float(its(*values))
        try:
            found = ours(*values)
        except _plain.REFUSALS:
            continue
        answered += 1
        assert type(found) is float
        assert found.hex() == wanted.hex()
    assert answered > 5


def test_what_reads_anything_else_is_left_to_numpy() -> None:
    least = 0.0

    def cubic_root(a: Any) -> Any:
        return np.cbrt(a)

    def nested(a: Any) -> Any:
        return [np.cbrt(v) for v in (a,)]

    def around(a: Any) -> Any:
        return np.sqrt(a) + least

    def root(a: Any) -> Any:
        return np.sqrt(a)

    for other in (cubic_root, nested, around):
        assert _plain.in_plain_numbers(other) is None
    assert _plain.in_plain_numbers(root)(4.0) == 2  # type: ignore[misc]
    assert type(_plain.in_plain_numbers(root)(4.0)) is float  # type: ignore[misc]


def test_a_power_that_is_not_real_is_no_number() -> None:
    """Python's would be complex."""

    @_arrays.elementwise(arrays=1)
    def power(a: Any, c: Any) -> Any:
        return a**c

    assert np.isnan(power(-2.0, 0.5))
    assert power(4.0, 0.5) == 2


@pytest.mark.parametrize("b", [1e-310, 1e-200, 1e-20])
@pytest.mark.parametrize("name", ["tilt", "load", "moment", "K_N", "L_N"])
def test_nothing_is_told_of_denormal_numbers(name: str, b: float) -> None:
    function = getattr(rounded_wedge, name)
    given = {"a": 1.0, "c": 1.0, "E_star": 1.0, "b": b, "phi": 1.0}
    with warnings.catch_warnings(), np.errstate(all="warn"):
        warnings.simplefilter("error")
        number = function(**{n: given[n] for n in signature(function).parameters})
    array = function(**{n: np.array([given[n]]) for n in signature(function).parameters})
    assert np.array_equal(np.ravel(number), np.ravel(array), equal_nan=True)


@pytest.mark.parametrize("name", [n for n, v in vars(_plain._NUMPY).items() if callable(v)])
def test_no_function_tells_of_a_denormal_number(name: str) -> None:
    """It refuses, or knows the answer."""
    others = (1.0,) if name == "arctan2" else ()
    with warnings.catch_warnings(), np.errstate(all="warn"):
        warnings.simplefilter("error")
        for value in (5e-324, 1e-310, -1e-310):
            with suppress(*_plain.REFUSALS):
                getattr(_plain._NUMPY, name)(value, *others)


@pytest.mark.parametrize("by_table", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_logarithm_tells_of_numbers_that_are_tiny_or_huge(
    by_table: bool, sign: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """log(1 + q) is q, or log(q); so is the pressure of a wedge next to its apex."""
    monkeypatch.setattr(_logarithm, "BY_TABLE", by_table)
    known = {0.0: 0.0, 5e-324: 5e-324, 1e-310: 1e-310} | {q: math.log(q) for q in (1e20, 1.7e308)}
    with warnings.catch_warnings(), np.errstate(all="warn"):
        warnings.simplefilter("error")
        for given, wanted in known.items():
            found = _logarithm.plain_log1p(given)
            assert abs(found - wanted) <= math.ulp(wanted)
            assert found == wanted or by_table or given > 1
        for width in (1.0, 5e7):  # E* phi/pi log(2 a/|x|)
            found = wedge.pressure(sign * 1.2e-308, width, width, E_star=math.pi, phi=0.125)
            logarithm = math.log(2 * width) - math.log(1.2e-308)
            assert found == pytest.approx(0.125 * logarithm, rel=1e-14)


def test_a_logarithm_of_zero_has_no_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    for by_table in (True, False):
        monkeypatch.setattr(_logarithm, "BY_TABLE", by_table)
        assert bits(_plain.plain_kink_logarithm(-0.0, 1.0, 1.0)) == bits(0.0)


def test_the_angle_of_a_small_tangent_is_it() -> None:
    for tangent in np.geomspace(1e-300, 1e-9, 2001).tolist():
        assert float(np.arctan(tangent)) == tangent
