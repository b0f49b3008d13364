"""What goes into functions and what comes out: types, shapes, long arrays, what does not exist.

Formulas of a body in closed form, what is solved case by case on it, and bodies that are summed
over parts or integrated.  A warning anywhere is an error (pyproject.toml), and every call is made
where the caller has told NumPy to raise.
"""

import inspect
import itertools
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from generated import flat_rounded, hyperbola, wedge
from generated.runtime.arrays import shape_of
from generated.runtime.types import Contact, Regime

VALUES: Mapping[str, float] = {
    **{"x": 0.25, "a": 2.0, "c": 1.5, "P": 1.0, "M": 0.125, "alpha": 0.0625, "dQ": 0.5},
    **{"dsigma": 0.25, "dP": 0.375, "dM": -0.125, "f": 0.5, "E_star": 1.25},
    **{"Q": 0.3125, "sigma": 0.15625, "da": 0.0078125, "dc": 0.0078125},
}
"""A contact of every body whose own lengths and slopes are PARAMETER."""
PARAMETER = 0.375

CONTRACT = {
    "contact": "P, M=0.0, *, E_star, phi",
    "contact_at_tilt": "P, alpha=0.0, *, E_star, phi",
    "tilt": "a, c, *, phi",
    **dict.fromkeys(("load", "moment", "K_N", "L_N"), "a, c, *, E_star, phi"),
    "pressure": "x, a, c, *, E_star, phi",
    **dict.fromkeys(("K_T", "L_T"), "a, c, dQ, dsigma"),
    "stick_margin": "a, c, dP, dM, dQ, dsigma, *, f",
    "stick_zone": "first, second, dQ, dsigma, *, f, E_star, phi, mixed=False",
    "why": "first, second, dQ, dsigma, *, f, E_star, phi",
    "tension_threshold": "first, second, dQ, *, f, E_star, phi",
    **dict.fromkeys(
        ("slip_zones", "slip_error"),
        "a, c, dQ, dsigma, *, f, E_star, phi, da=0.0, dc=0.0, order=1",
    ),
    **dict.fromkeys(
        ("shear_change", "slip_range"), "x, first, second, dQ, dsigma, *, f, E_star, phi"
    ),
    "shear": "x, contact, Q, sigma, *, f, E_star, phi, dQ=0.0, dsigma=0.0",
    "march": "P, M, Q, sigma, *, f, E_star, phi",
    **dict.fromkeys(
        ("history", "steady_cycle"), "P, M, Q, sigma, *, f, E_star, phi, x=None, tol=0.001"
    ),
}
"""The contract of a wedge, written out: names, order and defaults of all arguments."""

INF, NAN = np.inf, np.nan
NEVER = {
    "P": (0.0, -1.0, NAN, INF),
    "M": (NAN, INF),
    "alpha": (NAN, INF, PARAMETER, -PARAMETER, 1e300),
    "a": (NAN, INF, -1.5, -2.0, 0.0, -1.0),
    "c": (NAN, INF, -2.0, -1e300, 0.0, -1.0),
    "x": (NAN,),
    **dict.fromkeys(("dQ", "dsigma", "dP", "dM", "Q", "sigma", "da", "dc"), (NAN,)),
}
"""Values of one argument with which no state exists; a = -1.5 is no width.  The tilt of a wedge
ends at its own slope, and its contact spans the apex."""
NEVER_CONSTANT = (0.0, -0.0, -1.0, NAN, INF, -INF)
ANY_WIDTH = ("K_T", "L_T", "stick_margin", "flat_rounded", "hyperbola")
"""Functions and bodies with a contact of any width, wherever it lies."""

SOLVED = ("stick_zone", "tension_threshold", "slip_zones", "slip_error")
SOLVED += ("shear_change", "slip_range", "shear")
FORMULAS: dict[str, Callable[..., Any]] = {
    f"wedge.{name}": getattr(wedge, name) for name in [*CONTRACT][: [*CONTRACT].index("stick_zone")]
}
FUNCTIONS = {
    **FORMULAS,
    **{f"wedge.{name}": getattr(wedge, name) for name in SOLVED},
    **{f"flat_rounded.{name}": getattr(flat_rounded, name) for name in ("contact", "K_N", "L_N")},
    **{f"hyperbola.{name}": getattr(hyperbola, name) for name in ("tilt", "pressure", "K_N")},
}
FORMULA = pytest.mark.parametrize("name", FORMULAS)
EACH = pytest.mark.parametrize("name", FUNCTIONS)


def arguments(name: str) -> list[str]:
    """All that are real numbers; the edges of a contact are two of them, as `first.a`."""
    found = []
    for argument in inspect.signature(FUNCTIONS[name]).parameters:
        if argument in ("first", "second", "contact"):
            found += [f"{argument}.a", f"{argument}.c"]
        elif argument not in ("order", "mixed"):
            found.append(argument)
    return found


def values(name: str) -> dict[str, Any]:
    """A state that exists."""
    return {of: VALUES.get(of.rpartition(".")[2], PARAMETER) for of in arguments(name)}


def call(name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a result by name; the only one of an array is ''."""
    held = {k: v for k, v in given.items() if "." not in k}
    for contact in {k.partition(".")[0] for k in given if "." in k}:
        held[contact] = Contact(given[f"{contact}.a"], given[f"{contact}.c"], 0.0)
    with np.errstate(all="raise"):
        result = FUNCTIONS[name](**held)
    return result._asdict() if isinstance(result, tuple) else {"": result}


def one_by_one(name: str, given: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The same, from one call with Python floats for every element."""
    spread = np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in given.values()))
    rows = [
        call(name, {k: float(v[i]) for k, v in zip(given, spread, strict=True)})
        for i in np.ndindex(spread[0].shape)
    ]
    return {f: np.array([r[f] for r in rows]).reshape(spread[0].shape) for f in rows[0]}


def same(got: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    """Equal fields of one type and of one shape, NaN equal to NaN."""
    assert got.keys() == wanted.keys()
    for field, expected in wanted.items():
        assert got[field].dtype == expected.dtype == type_of(field)
        assert got[field].shape == expected.shape
        assert_allclose(got[field], expected, rtol=1e-14, atol=1e-15)


def type_of(field: str) -> type:
    return np.int64 if field == "regime" else np.float64


def missing(value: Any) -> Any:
    """Where there is none; a regime has a code for it."""
    return np.isnan(value) if value.dtype == np.float64 else value == Regime.NONE


def varied(name: str, count: int) -> dict[str, np.ndarray]:
    """Different states in every element, most of them existing."""
    rng = np.random.default_rng(1)
    found = {}
    for argument, value in values(name).items():
        signs = rng.choice([-1.0, 1.0], count) if argument in ("x", "M", "alpha", "dsigma") else 1.0
        found[argument] = value * 2.0 ** rng.uniform(-2, 2, count) * signs
    return found


# ------------------------------------------------------------------ the contract


def test_signatures_are_those_of_the_contract() -> None:
    def told(function: Any) -> str:
        given = inspect.signature(function)
        bare = [p.replace(annotation=p.empty) for p in given.parameters.values()]
        return str(given.replace(parameters=bare, return_annotation=given.empty))[1:-1]

    functions = [name for name in wedge.__all__ if not inspect.isclass(getattr(wedge, name))]
    assert {name: told(getattr(wedge, name)) for name in functions} == CONTRACT


def test_a_constant_of_another_body_is_refused_by_name() -> None:
    with pytest.raises(TypeError, match=r"contact\(\) got an unexpected keyword argument 'R'"):
        wedge.contact(2e6, 100.0, E_star=6e10, R=0.05)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"contact\(\) missing 1 required .* argument: 'phi'"):
        wedge.contact(2e6, 100.0, E_star=6e10)  # type: ignore[call-arg]


# ------------------------------------------------------------------ numbers and arrays

SCALARS: tuple[Callable[[float], Any], ...] = (
    *(float, np.float64, np.float32, np.float16, np.longdouble, np.array, np.ma.array),
)


def test_a_scalar_of_any_kind_gives_a_float64() -> None:
    for name, kind in itertools.product(FUNCTIONS, SCALARS):
        got = call(name, {k: kind(v) for k, v in values(name).items()})
        assert all(type(v) is type_of(field) for field, v in got.items())
        same(got, call(name, values(name)))


class OnlyConverts:
    """An array of another library that NumPy can convert, such as JAX's."""

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self.values if dtype is None else self.values.astype(dtype)


FORMS: dict[str, Callable[[np.ndarray], Any]] = {
    "list": lambda v: v.tolist(),
    "big-endian": lambda v: v.astype(">f8"),
    "unaligned": lambda v: np.frombuffer(b"\0" + v.tobytes(), np.uint8)[1:].view(np.float64),
    "read-only": lambda v: (v.setflags(write=False), v)[1],
    "Fortran": lambda v: np.asfortranarray(v.reshape(3, 4)),
    "a window": lambda v: np.pad(v.reshape(3, 4), 2, constant_values=np.nan)[2:-2, 2:-2],
    "of another library": OnlyConverts,
}


@pytest.mark.parametrize("form", FORMS)
def test_an_array_of_any_form_is_taken_element_by_element(form: str) -> None:
    for name in FUNCTIONS:
        given = {k: FORMS[form](v) for k, v in varied(name, 12).items()}
        got = call(name, given)
        assert {type(v) for v in got.values()} == {np.ndarray}
        same(got, one_by_one(name, given))


@EACH
def test_what_is_masked_is_nan(name: str) -> None:
    for argument, kind in itertools.product(arguments(name), (np.float64, np.int8)):
        given = {k: np.full(3, v) for k, v in values(name).items()}
        masked = np.ma.array(np.ones(3, kind), mask=[False, True, False])
        wanted = call(name, given | {argument: np.ones(3)})
        for field, value in call(name, given | {argument: masked}).items():
            assert type(value) is np.ndarray and missing(value[1])
            assert_array_equal(value[::2], wanted[field][::2])
        got = call(name, values(name) | {argument: np.ma.masked})
        assert all(type(v) is type_of(f) and missing(v) for f, v in got.items())


@EACH
def test_all_arguments_broadcast(name: str) -> None:
    tall, wide = np.array([[1.0], [1.125], [0.75]]), np.array([[1.0, 1.25, 0.875, 1.5]])
    for first, second in itertools.pairwise([*arguments(name), arguments(name)[0]]):
        given = values(name)
        given[first], given[second] = given[first] * tall, given[second] * wide
        got = call(name, given)
        assert all(value.shape == (3, 4) for value in got.values()), (first, second)
        same(got, one_by_one(name, given))


def test_shapes_that_do_not_broadcast_are_named() -> None:
    words = r"must broadcast to one shape; their shapes are a \(2, 3\), c \(2,\)"
    with pytest.raises(ValueError, match=words):
        shape_of({"a": np.ones((2, 3)), "c": np.ones(2), "R": np.float64(1)})
    for name in FUNCTIONS:
        first, second = arguments(name)[:2]
        given = values(name) | {first: np.ones((2, 20_000)), second: np.ones((3, 1))}
        with pytest.raises(ValueError, match=rf"{first} \(2, 20000\)") as caught:
            call(name, given)
        assert f"{second} (3, 1)" in str(caught.value)


# ------------------------------------------------------------------ long arrays

MANY = 2 * np.getbufsize() + 1003
LAYOUTS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "Fortran": lambda v: np.asfortranarray(v[: MANY // 6 * 6].reshape(6, -1)),
    "repeated": lambda v: np.broadcast_to(v[:200], (250, 200)),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_long_array_is_computed_as_its_parts_are(layout: str) -> None:
    for name in FORMULAS:
        given = {k: LAYOUTS[layout](v) for k, v in varied(name, MANY).items()}
        shape = next(iter(given.values())).shape
        flat = {k: v.ravel() for k, v in given.items()}
        starts = range(0, np.prod(shape), 9973)
        parts = [call(name, {k: v[i : i + 9973] for k, v in flat.items()}) for i in starts]
        wanted = {f: np.concatenate([p[f] for p in parts]).reshape(shape) for f in parts[0]}
        same(call(name, given), wanted)


# ------------------------------------------------------------------ states that do not exist


def nowhere(name: str) -> Iterator[tuple[str, float]]:
    """Arguments with a value with which no state exists."""
    loose = not {*ANY_WIDTH}.isdisjoint(name.split("."))
    for argument in arguments(name):
        for value in NEVER.get(argument, NEVER_CONSTANT):
            if not (loose and argument in ("a", "c") and -1.5 < value <= 0):
                yield argument, value


@EACH
def test_a_state_that_does_not_exist_is_nan_and_harms_nobody(name: str) -> None:
    """All of them in one array, each beside one that exists; and one by one."""
    wrong = list(nowhere(name))
    given = {k: np.full(2 * len(wrong), v) for k, v in values(name).items()}
    wanted = call(name, given)
    for place, (argument, value) in enumerate(wrong):
        given[argument][2 * place] = value
        alone = call(name, values(name) | {argument: value})
        assert all(missing(v) for v in alone.values()), (argument, value)
    for field, found in call(name, given).items():
        assert [w for w, v in zip(wrong, found[::2], strict=True) if not missing(v)] == []
        assert_array_equal(found[1::2], wanted[field][1::2])


@FORMULA
def test_extreme_numbers_raise_no_warning(name: str) -> None:
    """Overflow, underflow and cancellation stay inside; so do those of long double."""
    extremes = np.array([5e-324, 1e-308, 1e-160, 1e160, 1e308, -1e308, 1e-300])
    for first, second in itertools.combinations(arguments(name), 2):
        given = values(name) | {first: extremes[:, None], second: extremes}
        assert all(v.shape == (7, 7) for v in call(name, given).values())
        call(name, values(name) | {first: np.longdouble("1e4000")})
        call(name, values(name) | {first: np.array([np.longdouble("1e-4000")])})


# ------------------------------------------------------------------ what is no real number


class OnDevice:
    """An array of another library that refuses its conversion."""

    dtype, shape, ndim = np.dtype(np.float64), (3,), 1

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        raise TypeError("not allowed")


NO_NUMBERS: dict[str, Any] = {
    **{"bool": True, "bool list": [True, False], "complex": 1j, "masked": np.ma.array([1j])},
    **{"text": "1.0", "text array": np.array(["1.0"]), "nothing": None, "set": {1.0}},
    **{"list with nothing": [1.0, None], "object array": np.array([1.0], dtype=object)},
    **{"ragged list": [[1.0], [1.0, 2.0]], "record": np.zeros(1, dtype=[("a", "f8")])},
    **{"long text": "long" * 10_000, "on a device": OnDevice()},
}


@pytest.mark.parametrize("kind", NO_NUMBERS)
def test_what_is_no_real_number_is_refused_by_name_and_in_short(kind: str) -> None:
    given = NO_NUMBERS[kind]
    words = r"must be a real number or a list, NumPy or Dask array of real numbers; got "
    words += r"tests.*\.OnDevice " if isinstance(given, OnDevice) else type(given).__qualname__
    for name in FUNCTIONS:
        for argument in arguments(name):
            with pytest.raises(TypeError, match=rf"^{argument} {words}") as caught:
                call(name, values(name) | {argument: given})
            assert len(str(caught.value)) < 300
