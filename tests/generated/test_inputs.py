"""What goes into the generated functions and what comes out: types, shapes, what does not exist.

Bodies and functions are discovered; a new body brings no test code.  A warning anywhere is an error
(pyproject.toml), and every call is made where the caller has told NumPy to raise.
"""

import importlib
import inspect
import itertools
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from derive.codegen.cycle import CYCLE

Function = Callable[..., Any]

# A contact of every body whose own lengths and slopes are PARAMETER; all exact in binary.
VALUES: Mapping[str, float] = {
    "x": 0.25,
    "a": 2.0,
    "c": 1.5,
    "P": 1.0,
    "M": 0.125,
    "alpha": 0.0625,
    "dQ": 0.5,
    "dsigma": 0.25,
    "dP": 0.375,
    "dM": -0.125,
    "f": 0.5,
    "E_star": 1.25,
}
PARAMETER = 0.375
WHOLE = {"x": 7, "a": 120, "c": 110, "P": 100, "M": 90, "alpha": 0, "dQ": 80, "dsigma": 70} | {
    "dP": 60,
    "dM": 50,
}
"""Whole numbers that overflow an int8 as soon as two of them are added or multiplied."""
WHOLE_CONSTANT = 100
POSITIONAL = {
    "contact": "P, M=0.0",
    "contact_at_tilt": "P, alpha=0.0",
    "tilt": "a, c",
    "load": "a, c",
    "moment": "a, c",
    "pressure": "x, a, c",
    "K_N": "a, c",
    "L_N": "a, c",
    "K_T": "a, c, dQ, dsigma",
    "L_T": "a, c, dQ, dsigma",
    "stick_margin": "a, c, dP, dM, dQ, dsigma",
}
"""The contract, written out: names, order and defaults."""
RESULTS = {
    "contact": ("a", "c", "alpha"),
    "contact_at_tilt": ("a", "c", "alpha"),
    **dict.fromkeys(("K_N", "L_N", "K_T", "L_T", "stick_margin"), ("left", "right")),
}

INF, NAN = np.inf, np.nan
NEVER = {
    "P": (0.0, -0.0, -1.0, NAN, INF, -INF),
    "M": (NAN, INF, -INF),
    "alpha": (NAN, INF, -INF),
    "a": (NAN, INF, -INF, -1.5, -2.0, -1e300),
    "c": (NAN, INF, -INF, -2.0, -2.5, -1e300),
    "x": (NAN,),
    **dict.fromkeys(("dQ", "dsigma", "dP", "dM"), (NAN,)),
}
"""Values of one argument with which no state exists, whatever the body; a = -1.5 is no width."""
NEVER_CONSTANT = (0.0, -0.0, -1.0, -5e-324, NAN, -INF)
OWN = {
    "wedge": {
        "alpha": (PARAMETER, -PARAMETER, 0.5, -0.5, 1e300),
        "a": (0.0, -0.0, -1.0, -5e-324),
        "c": (0.0, -0.0, -1.0, -5e-324),
    }
}
"""More of them by body: the wedge's tilt ends at its own slope, its contact spans the apex."""
ALWAYS = {(name, edge) for name in ("K_T", "L_T", "stick_margin") for edge in "ac"}
"""What needs no more than a width: full stick knows nothing of the body."""


CYCLES = {cycle.name for cycle in CYCLE}
"""Functions of a whole cycle: they take contacts, and are tested in files of their own."""

KINDS = ("hertz", "wedge", "unequal_wedge")
"""Closed with a kink and without; test_library has what is solved and integrated."""

MODULES = {name: importlib.import_module(f"generated.{name}") for name in KINDS}
FUNCTIONS: dict[str, Function] = {
    f"{body}.{name}": getattr(module, name)
    for body, module in MODULES.items()
    for name in module.__all__
    if not inspect.isclass(getattr(module, name)) and name not in CYCLES
}
EACH = pytest.mark.parametrize("name", FUNCTIONS)


def arguments(name: str) -> list[str]:
    return list(inspect.signature(FUNCTIONS[name]).parameters)


def constants(name: str) -> list[str]:
    """Material and geometry."""
    parameters = inspect.signature(FUNCTIONS[name]).parameters.values()
    return [p.name for p in parameters if p.kind is p.KEYWORD_ONLY]


def cases() -> Iterator[tuple[str, str]]:
    """Every argument of every function."""
    return ((name, argument) for name in FUNCTIONS for argument in arguments(name))


def values(name: str) -> dict[str, Any]:
    """A state that exists."""
    return {argument: VALUES.get(argument, PARAMETER) for argument in arguments(name)}


def whole(name: str) -> dict[str, int]:
    return {argument: WHOLE.get(argument, WHOLE_CONSTANT) for argument in arguments(name)}


def call(name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a result by name; the only one of an array is ''."""
    with np.errstate(all="raise"):
        result = FUNCTIONS[name](**given)
    return result._asdict() if isinstance(result, tuple) else {"": result}


def one_by_one(name: str, given: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The same, from one call with Python floats for every element."""
    arrays = {k: np.asarray(v, dtype=np.float64) for k, v in given.items()}
    shape = np.broadcast_shapes(*(v.shape for v in arrays.values()))
    spread = {k: np.broadcast_to(v, shape) for k, v in arrays.items()}
    rows = [
        call(name, {k: float(v[index]) for k, v in spread.items()}) for index in np.ndindex(shape)
    ]
    fields = call(name, values(name))
    return {field: np.array([row[field] for row in rows]).reshape(shape) for field in fields}


def same(got: Mapping[str, Any], wanted: Mapping[str, Any], ulps: int = 0) -> None:
    """Equal fields of one dtype and shape, NaN equal to NaN."""
    assert got.keys() == wanted.keys()
    for field, expected in wanted.items():
        value = got[field]
        assert value.dtype == np.float64
        assert value.shape == expected.shape
        finite = np.isfinite(expected)
        assert np.array_equal(np.isfinite(value), finite), field
        assert np.array_equal(value[~finite], expected[~finite], equal_nan=True), field
        apart = np.abs(value[finite] - expected[finite])
        assert np.all(apart <= ulps * np.spacing(np.abs(expected[finite]))), field


def varied(name: str, count: int, seed: int = 1) -> dict[str, np.ndarray]:
    """Different states in every element, most of them existing."""
    rng = np.random.default_rng(seed)
    found = {}
    for argument, value in values(name).items():
        spread = 2.0 ** rng.uniform(-2, 2, count)
        signs = rng.choice([-1.0, 1.0], count) if argument in ("x", "M", "alpha", "dsigma") else 1.0
        found[argument] = value * spread * signs
    return found


# ------------------------------------------------------------------ the contract


def test_bodies_and_functions_are_found() -> None:
    assert {"hertz", "wedge"} <= MODULES.keys()
    assert {f"{b}.{f}" for b in ("hertz", "wedge") for f in POSITIONAL} <= FUNCTIONS.keys()


@EACH
def test_arguments_are_those_of_the_contract(name: str) -> None:
    """Extra functions of a body may take what they like, if this file has a value for it."""
    parameters = inspect.signature(FUNCTIONS[name]).parameters.values()
    positional = [p for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    short = ", ".join(
        p.name if p.default is p.empty else f"{p.name}={p.default}" for p in positional
    )
    assert short == POSITIONAL.get(name.partition(".")[2], short)
    assert {p.name for p in positional} <= VALUES.keys()
    assert len(positional) + len(constants(name)) == len(parameters)


@EACH
def test_constants_have_no_default(name: str) -> None:
    parameters = inspect.signature(FUNCTIONS[name]).parameters
    assert all(parameters[c].default is inspect.Parameter.empty for c in constants(name))


@EACH
def test_results_are_those_of_the_contract(name: str) -> None:
    result = FUNCTIONS[name](**values(name))
    fields = RESULTS.get(name.partition(".")[2])
    assert getattr(result, "_fields", None) == fields


@EACH
def test_arguments_may_be_given_by_place(name: str) -> None:
    given = values(name)
    named = {c: given[c] for c in constants(name)}
    placed = [given[argument] for argument in arguments(name) if argument not in named]
    result = FUNCTIONS[name](*placed, **named)
    fields = result._asdict() if isinstance(result, tuple) else {"": result}
    same(fields, call(name, given))


@EACH
def test_defaults_are_no_moment_and_no_tilt(name: str) -> None:
    parameters = inspect.signature(FUNCTIONS[name]).parameters
    optional = {p for p, v in parameters.items() if v.default is not inspect.Parameter.empty}
    given = {k: v for k, v in values(name).items() if k not in optional}
    same(call(name, given), call(name, given | dict.fromkeys(optional, 0.0)))


@EACH
def test_constants_are_given_by_name_alone(name: str) -> None:
    if constants(name):
        with pytest.raises(TypeError):
            FUNCTIONS[name](*values(name).values())


@EACH
def test_what_is_left_out_is_named(name: str) -> None:
    for argument, p in inspect.signature(FUNCTIONS[name]).parameters.items():
        if p.default is inspect.Parameter.empty:
            with pytest.raises(TypeError, match=rf"\b{argument}\b"):
                FUNCTIONS[name](**{k: v for k, v in values(name).items() if k != argument})


@EACH
def test_what_is_unknown_is_named(name: str) -> None:
    with pytest.raises(TypeError, match="surplus"):
        FUNCTIONS[name](**values(name), surplus=1.0)


# ------------------------------------------------------------------ numbers


SCALARS: dict[str, Callable[[float], Any]] = {
    "float": float,
    "float64": np.float64,
    "float32": np.float32,
    "float16": np.float16,
    "longdouble": np.longdouble,
    "0-d": np.array,
    "0-d float32": lambda v: np.array(v, np.float32),
    "0-d masked": np.ma.array,
}
WHOLES = (int, np.int8, np.uint8, np.int16, np.int32, np.int64, np.uint64)


@pytest.mark.parametrize("kind", SCALARS)
def test_a_scalar_of_any_kind_gives_a_float64(kind: str) -> None:
    for name in FUNCTIONS:
        got = call(name, {k: SCALARS[kind](v) for k, v in values(name).items()})
        assert {type(v) for v in got.values()} == {np.float64}
        same(got, call(name, values(name)))


@pytest.mark.parametrize("kind", WHOLES)
def test_whole_numbers_count_as_floats(kind: Callable[[int], Any]) -> None:
    """int8 would overflow in the first sum."""
    for name in FUNCTIONS:
        wanted = call(name, {k: float(v) for k, v in whole(name).items()})
        same(call(name, {k: kind(v) for k, v in whole(name).items()}), wanted)
        arrays = {k: np.array([kind(v), kind(v)]) for k, v in whole(name).items()}
        same(call(name, arrays), {f: np.array([v, v]) for f, v in wanted.items()})


def test_one_whole_number_among_floats_counts_as_a_float() -> None:
    for name, argument in cases():
        value = whole(name)[argument]
        wanted = call(name, values(name) | {argument: float(value)})
        for kind in (int, np.int8, np.int64):
            same(call(name, values(name) | {argument: kind(value)}), wanted)


# ------------------------------------------------------------------ arrays


def column(name: str) -> dict[str, np.ndarray]:
    return varied(name, 12)


FORMS: dict[str, Callable[[np.ndarray], Any]] = {
    "array": lambda v: v,
    "list": lambda v: v.tolist(),
    "tuple": lambda v: tuple(v.tolist()),
    "every second": lambda v: np.repeat(v, 2)[::2],
    "backwards": lambda v: v[::-1].copy()[::-1],
    "big-endian": lambda v: v.astype(">f8"),
    "unaligned": lambda v: np.frombuffer(b"\0" + v.tobytes(), np.uint8)[1:].view(np.float64),
    "read-only": lambda v: (v.setflags(write=False), v)[1],
    "long double": lambda v: v.astype(np.longdouble),
    "subclass": lambda v: v.view(type("Mine", (np.ndarray,), {})),
    "without a mask": lambda v: np.ma.array(v),
}
PLANES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "rows": lambda v: v.reshape(3, 4),
    "Fortran": lambda v: np.asfortranarray(v.reshape(3, 4)),
    "transposed": lambda v: v.reshape(4, 3).T,
    "a window": lambda v: np.pad(v.reshape(3, 4), 2, constant_values=np.nan)[2:-2, 2:-2],
    "three axes": lambda v: v.reshape(2, 3, 2),
    "axes of one": lambda v: v.reshape(1, 12, 1),
}


@pytest.mark.parametrize("form", FORMS)
def test_an_array_of_any_form_is_taken_element_by_element(form: str) -> None:
    for name in FUNCTIONS:
        given = column(name)
        wanted = one_by_one(name, given)
        got = call(name, {k: FORMS[form](v) for k, v in given.items()})
        assert {type(v) for v in got.values()} == {np.ndarray}
        same(got, wanted, ulps=1)


@pytest.mark.parametrize("form", PLANES)
def test_an_array_of_any_layout_is_taken_element_by_element(form: str) -> None:
    for name in FUNCTIONS:
        given = {k: PLANES[form](v) for k, v in column(name).items()}
        same(call(name, given), one_by_one(name, given), ulps=1)


@pytest.mark.parametrize("kind", [np.float32, np.float16, np.int8, np.int64])
def test_an_array_of_any_type_is_taken_as_float64(kind: type) -> None:
    for name in FUNCTIONS:
        given = {k: np.array([v, v + 1, v + 2]).astype(kind) for k, v in values(name).items()}
        same(call(name, given), call(name, {k: v.astype(np.float64) for k, v in given.items()}))


@EACH
def test_one_array_among_scalars_is_enough(name: str) -> None:
    for argument in arguments(name):
        given = values(name)
        given[argument] = given[argument] * np.array([1.0, 1.125, 0.75])
        same(call(name, given), one_by_one(name, given), ulps=1)


@EACH
def test_what_is_masked_is_nan(name: str) -> None:
    for argument in arguments(name):
        masked_is_nan(name, argument)


def masked_is_nan(name: str, argument: str) -> None:
    given = {k: np.full(3, v) for k, v in values(name).items()}
    wanted = call(name, given)
    masked = np.ma.array(given[argument], mask=[False, True, False])
    got = call(name, given | {argument: masked})
    for field, value in got.items():
        assert not isinstance(value, np.ma.MaskedArray)
        assert np.isnan(value[1])
        assert np.array_equal(value[::2], wanted[field][::2])
    whole_masked = np.ma.array([1, 1, 1], mask=[False, True, False], dtype=np.int8)
    got = call(name, given | {argument: whole_masked})
    assert all(np.isnan(value[1]) for value in got.values())
    assert not np.any(np.isnan(np.ma.getdata(masked)))


@pytest.mark.parametrize("value", [np.ma.masked, np.ma.array(1.0, mask=True)], ids=["it", "0-d"])
def test_a_masked_scalar_is_nan(value: Any) -> None:
    for name, argument in cases():
        got = call(name, values(name) | {argument: value})
        assert {type(v) for v in got.values()} == {np.float64}
        assert all(np.isnan(v) for v in got.values())


# ------------------------------------------------------------------ broadcasting


@EACH
def test_every_argument_broadcasts_against_every_other(name: str) -> None:
    tall, wide = np.array([[1.0], [1.125], [0.75]]), np.array([[1.0, 1.25, 0.875, 1.5]])
    for first, second in itertools.permutations(arguments(name), 2):
        given = values(name)
        given[first], given[second] = given[first] * tall, given[second] * wide
        got = call(name, given)
        assert all(value.shape == (3, 4) for value in got.values()), (first, second)
        same(got, one_by_one(name, given), ulps=1)


@EACH
def test_all_arguments_broadcast_at_once(name: str) -> None:
    given, names = values(name), arguments(name)
    for axis, argument in enumerate(names):
        shape = [1] * len(names)
        shape[axis] = 2
        given[argument] = given[argument] * np.array([1.0, 1.125]).reshape(shape)
    got = call(name, given)
    assert all(value.shape == (2,) * len(names) for value in got.values())
    same(got, one_by_one(name, given), ulps=1)


@EACH
def test_a_missing_axis_is_added_in_front(name: str) -> None:
    for argument in arguments(name):
        given = {k: np.full((2, 3), v) for k, v in values(name).items()}
        given[argument] = values(name)[argument] * np.array([1.0, 1.125, 0.75])
        same(call(name, given), one_by_one(name, given), ulps=1)


@pytest.mark.parametrize(
    ("shape", "others", "result"),
    [
        ((0,), (), (0,)),
        ((0,), (1,), (0,)),
        ((3, 0), (), (3, 0)),
        ((0, 3), (3,), (0, 3)),
        ((0, 1), (1, 20_000), (0, 20_000)),
        ((20_000, 1), (1, 0), (20_000, 0)),
        ((1, 0, 1), (2, 1, 20_000), (2, 0, 20_000)),
    ],
)
def test_what_is_empty_gives_what_is_empty(
    shape: tuple[int, ...], others: tuple[int, ...], result: tuple[int, ...]
) -> None:
    for name, argument in cases():
        given = {k: np.full(others, v) for k, v in values(name).items()}
        got = call(name, given | {argument: np.full(shape, values(name)[argument])})
        assert all(v.shape == result and v.dtype == np.float64 for v in got.values())


@EACH
def test_an_empty_list_is_an_empty_array(name: str) -> None:
    for argument in arguments(name):
        got = call(name, values(name) | {argument: []})
        assert all(v.shape == (0,) and v.dtype == np.float64 for v in got.values())


@EACH
def test_shapes_that_do_not_broadcast_are_named(name: str) -> None:
    for first, second in itertools.permutations(arguments(name), 2):
        for shapes in (((2,), (3,)), ((2, 3), (2,)), ((0,), (2,)), ((2, 20_000), (3, 1))):
            given = values(name)
            for argument, shape in zip((first, second), shapes, strict=True):
                given[argument] = np.full(shape, given[argument])
            with pytest.raises(ValueError, match="broadcast") as caught:
                call(name, given)
            said = str(caught.value)
            assert f"{first} {shapes[0]}" in said
            assert f"{second} {shapes[1]}" in said


# ------------------------------------------------------------------ large arrays

MANY = 50_003  # a prime, more than any block


@EACH
def test_a_large_array_is_computed_as_its_parts_are(name: str) -> None:
    given = varied(name, MANY)
    got = call(name, given)
    step = 997
    parts = [
        call(name, {k: v[start : start + step] for k, v in given.items()})
        for start in range(0, MANY, step)
    ]
    same(got, {f: np.concatenate([part[f] for part in parts]) for f in got}, ulps=1)


@EACH
def test_a_large_array_is_computed_as_its_elements_are(name: str) -> None:
    given = varied(name, MANY)
    got = call(name, given)
    chosen = np.r_[0:20, 16_374:16_394, 32_758:32_778, MANY - 20 : MANY, 1000:MANY:499]
    wanted = one_by_one(name, {k: v[chosen] for k, v in given.items()})
    same({f: v[chosen] for f, v in got.items()}, wanted, ulps=1)


LARGE: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "rows": lambda v: v.reshape(250, 200),
    "Fortran": lambda v: np.asfortranarray(v.reshape(250, 200)),
    "transposed": lambda v: v.reshape(250, 200).T,
    "long rows": lambda v: v.reshape(2, 25_000),
    "short rows": lambda v: v.reshape(25_000, 2),
    "backwards": lambda v: v[::-1],
    "every second": lambda v: np.repeat(v, 2)[::2],
    "four axes": lambda v: v.reshape(5, 4, 1, 2500),
    "read-only": lambda v: np.broadcast_to(v[:200], (250, 200)),
}


@pytest.mark.parametrize("form", LARGE)
def test_a_large_array_of_any_layout_is_computed_alike(form: str) -> None:
    for name in FUNCTIONS:
        given = {k: LARGE[form](v) for k, v in varied(name, 50_000).items()}
        wanted = call(name, {k: v.ravel() for k, v in given.items()})
        shape = next(iter(given.values())).shape
        same(call(name, given), {f: v.reshape(shape) for f, v in wanted.items()}, ulps=1)


@EACH
def test_large_arrays_broadcast(name: str) -> None:
    """A column against a row, every pair of arguments; each result is as large as 300 x 101."""
    states = varied(name, 300)
    for first, second in itertools.combinations(arguments(name), 2):
        given = values(name)
        given[first], given[second] = states[first][:, None], states[second][None, :101]
        got = call(name, given)
        for i, j in ((0, 0), (299, 100), (7, 93), (150, 1)):
            one = call(name, given | {first: states[first][i], second: states[second][j]})
            same({f: v[i, j] for f, v in got.items()}, one, ulps=1)
        assert all(v.shape == (300, 101) for v in got.values())


@EACH
def test_a_large_result_of_one_large_argument(name: str) -> None:
    for argument in arguments(name):
        given = values(name) | {argument: varied(name, MANY)[argument]}
        got = call(name, given)
        wanted = call(name, {k: np.broadcast_to(v, MANY) for k, v in given.items()})
        same(got, wanted, ulps=1)


# ------------------------------------------------------------------ what is given stays as it was


@EACH
@pytest.mark.parametrize("count", [1, 12, MANY])
def test_no_input_is_changed(name: str, count: int) -> None:
    given = varied(name, count)
    for array in given.values():
        array[count // 2] = np.nan
    before = {k: v.copy() for k, v in given.items()}
    call(name, given)
    assert all(np.array_equal(v, before[k], equal_nan=True) for k, v in given.items())


@EACH
@pytest.mark.parametrize("count", [12, MANY])
def test_no_result_is_an_input(name: str, count: int) -> None:
    """What a caller does to a result must not reach what was given, nor the other field."""
    given = {k: np.full(count, v) for k, v in values(name).items()}
    got = call(name, given)
    for value in got.values():
        assert not any(np.shares_memory(value, array) for array in given.values())
        value[:] = -1.0
    assert all(np.all(array == values(name)[k]) for k, array in given.items())


@EACH
@pytest.mark.parametrize("count", [12, MANY])
def test_no_result_is_another_one(name: str, count: int) -> None:
    got = call(name, {k: np.full(count, v) for k, v in values(name).items()})
    for first, second in itertools.combinations(got.values(), 2):
        assert not np.shares_memory(first, second)
    assert all(value.flags.writeable for value in got.values())


# ------------------------------------------------------------------ states that do not exist


def nowhere(name: str) -> Iterator[tuple[str, float]]:
    """Arguments with a value with which no state exists."""
    body, _, function = name.partition(".")
    for argument in arguments(name):
        yield from ((argument, value) for value in NEVER.get(argument, NEVER_CONSTANT))
        if (function, argument) not in ALWAYS:
            yield from ((argument, value) for value in OWN.get(body, {}).get(argument, ()))


@EACH
def test_a_state_that_does_not_exist_is_nan(name: str) -> None:
    wrong = {}
    for argument, value in nowhere(name):
        got = call(name, values(name) | {argument: value})
        assert {type(v) for v in got.values()} == {np.float64}
        if not all(np.isnan(v) for v in got.values()):
            wrong[argument, value] = got
    assert wrong == {}


@EACH
def test_an_infinite_constant_makes_no_state(name: str) -> None:
    """No material is rigid, and a body without curvature or slope is none: 0 would look right."""
    got = {c: call(name, values(name) | {c: np.inf}) for c in constants(name)}
    assert {c: v for c, v in got.items() if not all(map(np.isnan, v.values()))} == {}


@EACH
def test_it_does_no_harm_to_its_neighbours(name: str) -> None:
    for argument, value in nowhere(name):
        given = {k: np.full(5, v) for k, v in values(name).items()}
        wanted = call(name, given)
        given[argument][2] = value
        for field, found in call(name, given).items():
            assert np.array_equal(np.delete(found, 2), np.delete(wanted[field], 2))


@EACH
def test_of_many_states_only_those_that_do_not_exist_are_nan(name: str) -> None:
    """All of them in one array, each beside one that exists."""
    wrong = list(nowhere(name))
    given = {k: np.full(2 * len(wrong), v) for k, v in values(name).items()}
    wanted = call(name, given)
    for place, (argument, value) in enumerate(wrong):
        given[argument][2 * place] = value
    for field, found in call(name, given).items():
        assert [w for w, v in zip(wrong, found[::2], strict=True) if not np.isnan(v)] == []
        assert np.array_equal(found[1::2], wanted[field][1::2])


@EACH
def test_a_missing_number_in_a_large_array_does_no_harm(name: str) -> None:
    given = varied(name, MANY)
    wanted = call(name, given)
    first = arguments(name)[0]
    given[first][::7] = np.nan
    for field, found in call(name, given).items():
        others = np.arange(MANY) % 7 != 0
        assert np.all(np.isnan(found[~others]))
        assert np.array_equal(found[others], wanted[field][others], equal_nan=True)


@EACH
def test_all_that_is_wrong_at_once_is_nan(name: str) -> None:
    for bad in (0.0, -1.0, np.nan, np.inf, -np.inf):
        got = call(name, {k: bad if k != "x" else 0.0 for k in arguments(name)})
        assert all(np.isnan(v) for v in got.values()), bad


@EACH
def test_extreme_numbers_raise_no_warning(name: str) -> None:
    """Overflow, underflow and cancellation stay inside."""
    extremes = np.array([5e-324, 1e-308, 1e-160, 1e160, 1e308, -1e308, 1e-300])
    for first, second in itertools.permutations(arguments(name), 2):
        given = values(name) | {first: extremes[:, None], second: extremes}
        assert all(v.shape == (7, 7) for v in call(name, given).values())


@pytest.mark.parametrize("text", ["1e4000", "1e-4000"])
def test_a_number_beyond_float64_raises_no_warning(text: str) -> None:
    """It is infinite or zero in float64."""
    value = np.longdouble(text)
    if not np.isfinite(value) or value == 0:
        pytest.skip("long double is no larger than float64 here")
    for name, argument in cases():
        wanted = call(name, values(name) | {argument: float(text)})
        same(call(name, values(name) | {argument: value}), wanted)
        got = call(name, values(name) | {argument: np.array([value])})
        same(got, {f: np.array([v]) for f, v in wanted.items()})


def test_threads_do_not_disturb_each_other() -> None:
    """Each of them has told NumPy to raise, and has values of its own."""
    states = [(name, varied(name, count, seed=count)) for name in FUNCTIONS for count in (9, MANY)]
    wanted = [call(name, given) for name, given in states]
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda state: call(*state), states * 3))
    for got, expected in zip(found, wanted * 3, strict=True):
        same(got, expected)


@EACH
def test_what_the_caller_told_numpy_stays(name: str) -> None:
    with np.errstate(divide="raise", over="warn", under="print", invalid="call"):
        before = np.geterr()
        FUNCTIONS[name](**{k: np.nan for k in arguments(name)})
        assert np.geterr() == before


# ------------------------------------------------------------------ what is no real number

NO_NUMBERS = {
    "bool": True,
    "false": False,
    "numpy bool": np.True_,
    "bool array": np.array([True, False]),
    "bool list": [True, False],
    "masked bool": np.ma.array([True, False]),
    "complex": 1j,
    "numpy complex": np.complex64(1),
    "complex array": np.array([1.0 + 0j]),
    "complex list": [1.0, 2j],
    "masked complex": np.ma.array([1.0 + 1j]),
    "text": "1.0",
    "bytes": b"1.0",
    "text array": np.array(["1.0"]),
    "masked text": np.ma.array(["1.0"]),
    "nothing": None,
    "list with nothing": [1.0, None],
    "object": object(),
    "object array": np.array([1.0], dtype=object),
    "ragged list": [[1.0], [1.0, 2.0]],
    "dict": {"a": 1.0},
    "set": {1.0},
    "function": abs,
    "date": np.datetime64("2001-01-01"),
    "duration": np.timedelta64(1, "s"),
    "record": np.zeros(1, dtype=[("a", "f8")]),
}


def refusal(name: str, given: Mapping[str, Any]) -> str:
    """What the function says to arguments that it refuses."""
    try:
        call(name, given)
    except TypeError as error:
        return str(error)
    return "nothing"


@pytest.mark.parametrize("kind", NO_NUMBERS)
def test_what_is_no_real_number_is_refused_by_name(kind: str) -> None:
    said = {
        (name, argument): refusal(name, values(name) | {argument: NO_NUMBERS[kind]})
        for name, argument in cases()
    }
    assert {k: v for k, v in said.items() if v.split()[0] != k[1]} == {}


@EACH
def test_it_is_refused_by_name_in_its_place_too(name: str) -> None:
    given = values(name)
    names = [k for k in arguments(name) if k not in constants(name)]
    for place, argument in enumerate(names):
        placed = [given[k] for k in names]
        placed[place] = "1.0"
        with pytest.raises(TypeError) as caught:
            FUNCTIONS[name](*placed, **{k: given[k] for k in constants(name)})
        assert str(caught.value).split()[0] == argument


@EACH
def test_a_long_refused_value_is_shown_in_short(name: str) -> None:
    for argument in arguments(name):
        for value in ("long" * 10_000, ["long"] * 10_000, {*range(10_000)}):
            assert 0 < len(refusal(name, values(name) | {argument: value})) < 300


# ------------------------------------------------------------------ pressure outside

PRESSURES = [name for name in FUNCTIONS if name.endswith(".pressure")]
CONTACTS = [(2.0, 1.5), (0.7, 3.1), (1e-3, 3e-4), (1e12, 2e12), (0.1, 0.2)]


@pytest.mark.parametrize("name", PRESSURES)
@pytest.mark.parametrize(("a", "c"), CONTACTS)
def test_pressure_is_zero_at_the_edges_and_outside(name: str, a: float, c: float) -> None:
    own = {k: v for k, v in values(name).items() if k not in "xac"}
    own |= {k: PARAMETER * min(a, c) for k in own if k not in ("E_star", "phi")}
    beyond = np.array([0.0, 5e-324, 1e-15, 1e-3, 0.5, 1.0, 10.0, 1e10, 1e150, 1e300, np.inf])
    with np.errstate(over="ignore"):
        right, left = c + beyond * c, -(a + beyond * a)
    right[1], left[1] = np.nextafter(c, np.inf), np.nextafter(-a, -np.inf)
    for x in (left, right):
        got = call(name, {"x": x, "a": a, "c": c, **own})[""]
        assert np.array_equal(got, np.zeros(len(x)))
        assert not np.any(np.signbit(got))


@pytest.mark.parametrize("name", PRESSURES)
def test_pressure_is_zero_at_any_edges(name: str) -> None:
    rng = np.random.default_rng(3)
    a, c = 10 ** rng.uniform(-6, 6, (2, 2000))
    own = {k: v for k, v in values(name).items() if k not in "xac"}
    own |= {k: 1e-9 for k in own if k not in ("E_star", "phi")}
    for x in (-a, c, -a * (1 + 1e-15), c * (1 + 1e-15)):
        got = call(name, {"x": x, "a": a, "c": c, **own})[""]
        assert np.array_equal(got, np.zeros(2000))


@pytest.mark.parametrize("name", PRESSURES)
def test_pressure_is_positive_as_close_to_the_edges_as_can_be(name: str) -> None:
    own = values(name)
    for x in (np.nextafter(-own["a"], np.inf), np.nextafter(own["c"], -np.inf)):
        assert call(name, own | {"x": x})[""] > 0
