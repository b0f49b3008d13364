"""Arrays of other libraries, as far as NumPy's protocols carry: docs/arrays.md says how far.

No GPU is needed: `OnDevice` follows the protocols as CuPy's arrays do, and like them is never made
a NumPy array behind one's back.
"""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.testing import assert_array_equal

from generated import _logarithm, flat_rounded, hyperbola, wedge
from generated.runtime.types import Contact
from tests.generated.test_dask import OWN, fields, functions, given_to, module

FORWARD = ("tilt", "load", "moment", "pressure", "K_N", "L_N")
STUCK = ("K_T", "L_T", "stick_margin")
INVERSE = ("contact", "contact_at_tilt")
INTEGRATED = ("power", "hyperbola", "circular_arc", "catenary")
CLOSED_INVERSE = ("hertz", "wedge", "unequal_wedge")

COMPARISONS = (np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal)


class OnDevice(NDArrayOperatorsMixin):
    """An array of which NumPy sees nothing but the protocols."""

    def __init__(self, held: Any) -> None:
        self.held = np.asarray(held)

    dtype = property(lambda self: self.held.dtype)
    shape = property(lambda self: self.held.shape)
    ndim = property(lambda self: self.held.ndim)
    size = property(lambda self: self.held.size)

    def astype(self, dtype: Any) -> "OnDevice":
        return OnDevice(self.held.astype(dtype))

    def copy(self) -> "OnDevice":
        return OnDevice(self.held.copy())

    def __bool__(self) -> bool:
        return bool(self.held)

    def __getitem__(self, index: Any) -> "OnDevice":
        return OnDevice(self.held[index])

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        raise TypeError("implicit conversion to a NumPy array is not allowed")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **kwargs: Any) -> Any:
        if ufunc in COMPARISONS:  # a number on the left has become an array of no axes
            inputs = tuple(v[()] if isinstance(v, np.ndarray) else v for v in inputs)
        if method != "__call__" or any(isinstance(v, np.ndarray) for v in inputs):
            return NotImplemented
        return OnDevice(ufunc(*map(held, inputs), **kwargs))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        return OnDevice(function(*map(held, args), **{k: held(v) for k, v in kwargs.items()}))


def held(value: Any) -> Any:
    return value.held if isinstance(value, OnDevice) else value


def on_device(value: Any) -> Any:
    if isinstance(value, Contact):
        return Contact(*map(on_device, value))
    return OnDevice(value) if np.ndim(value) else value


def call(body: str, name: str) -> tuple[Callable[..., Any], dict[str, Any]]:
    """A function and its arguments, the constants numbers."""
    function = getattr(module(body), name)
    constants = {
        n for n, p in inspect.signature(function).parameters.items() if p.kind is p.KEYWORD_ONLY
    }
    given = given_to(body, name)
    return function, {k: np.ravel(v)[0] if k in constants else v for k, v in given.items()}


def works(body: str, name: str) -> bool:
    """What docs/arrays.md promises."""
    if name in FORWARD:
        return body not in INTEGRATED
    return name in STUCK or (name in INVERSE and body in CLOSED_INVERSE)


@pytest.mark.parametrize(
    ("body", "name"), [(b, n) for b in OWN for n in functions(b) if works(b, n)]
)
def test_explicit_formulas_stay_on_the_device(
    body: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the bit, if NumPy's own log1p is taken here as it is there."""
    monkeypatch.setattr(_logarithm, "BY_TABLE", False)
    function, given = call(body, name)
    found = function(**{k: on_device(v) for k, v in given.items()})
    for one, other in zip(fields(found), fields(function(**given)), strict=True):
        assert type(one) is OnDevice
        assert one.dtype == np.float64
        assert_array_equal(one.held, other)


@pytest.mark.parametrize(
    ("body", "name"), [(b, n) for b in OWN for n in functions(b) if not works(b, n)]
)
def test_what_is_solved_or_integrated_refuses(body: str, name: str) -> None:
    function, given = call(body, name)
    with pytest.raises(TypeError, match=r"NumPy and Dask arrays alone.*OnDevice"):
        function(**{k: on_device(v) for k, v in given.items()})


@pytest.mark.parametrize("name", FORWARD)
def test_a_kink_beside_an_edge_and_a_part_far_away_stay_there_too(name: str) -> None:
    """The part beyond the kink is 1e-7 of the contact wide, and x a million of its widths away."""
    given = {"x": [0.0, 0.4], "a": [1.0, 0.5], "c": [0.5000001, 0.5000002]}
    wanted = inspect.signature(getattr(flat_rounded, name)).parameters
    constants = {k: v for k, v in {"E_star": 1.0, "R": 1.0, "b": 0.5}.items() if k in wanted}
    own, device = (
        getattr(flat_rounded, name)(
            **{k: of(v) for k, v in given.items() if k in wanted}, **constants
        )
        for of in (np.array, OnDevice)
    )
    for one, other in zip(fields(device), fields(own), strict=True):
        assert_array_equal(one.held, other)


@pytest.mark.parametrize("body", ["flat_rounded", "hertz", "wedge"])
@pytest.mark.parametrize("name", [n for n in FORWARD if n != "pressure"])
def test_an_array_beside_edges_that_are_numbers_stays_on_the_device(body: str, name: str) -> None:
    function, given = call(body, name)
    given |= {k: 3.0 for k in "ac"}
    modulus = np.array([1.0, 2.0])
    for other in set(given) - {"a", "c"}:
        found = function(**given | {other: OnDevice(modulus)})
        for one, own in zip(
            fields(found), fields(function(**given | {other: modulus})), strict=True
        ):
            assert_array_equal(held(one), own)


@pytest.mark.parametrize("dtype", [np.int8, np.float32])
def test_numbers_become_float64_first(dtype: Any) -> None:
    a = np.array([100, 120], dtype)
    found = wedge.load(OnDevice(a), 100.0, E_star=1.0, phi=0.25)
    assert_array_equal(found.held, wedge.load(a, 100.0, E_star=1.0, phi=0.25))


def test_what_is_no_real_number_is_refused() -> None:
    with pytest.raises(TypeError, match="a must be a real number or an array of such"):
        wedge.load(OnDevice([1j]), 1.0, E_star=1.0, phi=0.25)


class OnlyConverts:
    """An array without the protocols, but for the way to NumPy: JAX's are such."""

    def __init__(self, held: Any) -> None:
        self.held = np.asarray(held, dtype=np.float32)

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self.held.astype(dtype) if dtype is not None else self.held


def test_an_array_that_only_converts_gives_numpy_arrays() -> None:
    P = np.array([1.0, 1.5, 2.0], np.float32)
    found = hyperbola.contact(OnlyConverts(P), 0.25, E_star=1.0, b=0.5, phi=0.25)
    known = hyperbola.contact(P, 0.25, E_star=1.0, b=0.5, phi=0.25)
    for one, other in zip(found, known, strict=True):
        assert type(one) is np.ndarray
        assert_array_equal(one, other)


class OfATracer:
    """A value that is not there, inside jax.jit: it does not convert."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        raise TypeError("abstract")


def test_a_tracer_is_refused_by_name() -> None:
    with pytest.raises(TypeError, match=r"P must be a real number or an array of such.*OfATracer"):
        wedge.contact(OfATracer(), 0.25, E_star=1.0, phi=0.25)
