"""Arrays of other libraries, as far as NumPy's protocols carry: docs/arrays.md says how far.

No GPU is needed: `OnDevice` follows the protocols as CuPy's arrays do, and like them is never made
a NumPy array behind one's back.
"""

import importlib
import inspect
from typing import Any

import numpy as np
import pytest
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.testing import assert_allclose

from derive.library import library
from generated import flat_rounded, hyperbola, wedge
from generated.runtime.types import Contact
from tests.generated.test_library import OWN

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


def fields(result: Any) -> tuple[Any, ...]:
    return result if isinstance(result, tuple) else (result,)


def given_to(body: str, name: str) -> dict[str, Any]:
    """Values of every argument without a default; the constants are numbers."""
    a, c = np.array([1.25, 1.5, 1.125]), np.array([1.5, 1.25, 1.0625])
    a, c = (0.25 * v if body == "circular_arc" else v for v in (a, c))
    here = Contact(a, c, np.zeros(3))
    values = {"a": a, "c": c, "P": a, "M": 0.1 * c, "alpha": 0.01 * c, "x": 0.3 * (c - a)}
    values |= {"first": here, "second": here, "contact": here, "Q": 0.1 * a, "sigma": 0.01 * a}
    values |= {"dQ": 0.1 * a, "dsigma": 0.01 * a, "dP": 0.1 * a, "dM": 0.1 * a}
    values |= {"f": 0.5, "E_star": 1.25, **OWN[body]}
    function = getattr(importlib.import_module(f"generated.{body}"), name)
    parameters = inspect.signature(function).parameters.values()
    return {p.name: values[p.name] for p in parameters if p.default is p.empty}


def on_device(value: Any) -> Any:
    if isinstance(value, Contact):
        return Contact(*map(on_device, value))
    return OnDevice(value) if np.ndim(value) else value


def works(body: str, name: str) -> bool:
    """What docs/arrays.md promises."""
    if name in FORWARD:
        return body not in INTEGRATED
    return name in STUCK or (name in INVERSE and body in CLOSED_INVERSE)


@pytest.mark.parametrize("body", library())
def test_explicit_formulas_stay_on_the_device_and_others_refuse(body: str) -> None:
    of = importlib.import_module(f"generated.{body}")
    for name in of.__all__:
        function = getattr(of, name)
        if inspect.isclass(function):
            continue
        given = given_to(body, name)
        device = {k: on_device(v) for k, v in given.items()}
        if not works(body, name):
            with pytest.raises(TypeError, match=r"only NumPy and Dask arrays.*OnDevice"):
                function(**device)
            continue
        for one, other in zip(fields(function(**device)), fields(function(**given)), strict=True):
            assert type(one) is OnDevice and one.dtype == np.float64
            assert_allclose(one.held, other, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("name", FORWARD)
def test_an_array_beside_edges_that_are_numbers_stays_on_the_device(name: str) -> None:
    """Beside a kink, too: what a part far away contributes is a formula of the same kind."""
    own = {"a": 1.0, "c": 0.5000001, "x": 0.4, "E_star": 1.0, "R": 1.0, "b": 0.5}
    function = getattr(flat_rounded, name)
    given = {k: own[k] for k in inspect.signature(function).parameters}
    for other in set(given) - {"a", "c"}:
        several = given[other] * np.array([1.0, 0.9])
        found = fields(function(**given | {other: OnDevice(several)}))
        for one, known in zip(found, fields(function(**given | {other: several})), strict=True):
            assert_allclose(held(one), known, rtol=1e-14)


class OnlyConverts:
    """An array without the protocols, but for the way to NumPy: JAX's are such.

    abstract: inside jax.jit, where a value is not there and does not convert.
    """

    def __init__(self, held: Any, abstract: bool = False) -> None:
        self.held, self.abstract = np.asarray(held, dtype=np.float32), abstract

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        if self.abstract:
            raise TypeError("abstract")
        return self.held.astype(dtype) if dtype is not None else self.held


def test_an_array_that_only_converts_gives_numpy_arrays() -> None:
    P, own = np.array([1.0, 1.5, 2.0], np.float32), {"E_star": 1.0, "b": 0.5, "phi": 0.25}
    found = hyperbola.contact(OnlyConverts(P), 0.25, **own)
    for one, other in zip(found, hyperbola.contact(P, 0.25, **own), strict=True):
        assert type(one) is np.ndarray
        assert_allclose(one, other, rtol=1e-14)
    with pytest.raises(TypeError, match=r"P must be a real number .*OnlyConverts"):
        wedge.contact(OnlyConverts(P, abstract=True), 0.25, E_star=1.0, phi=0.25)
