"""The functions that are bound to a body: signature, docstring, example, and where they live."""

import doctest
import importlib
import inspect
import math
import pickle
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from derive.library import library
from generated import hertz, wedge
from generated.runtime.body import Body, Parameter, kernel_of
from generated.runtime.cycle import CYCLE, SOLVED

EVERY = pytest.mark.parametrize("name", library())


def module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def bound(of: ModuleType) -> dict[str, Any]:
    """Its functions of a whole cycle, and those that are solved for."""
    held = {f.__name__: getattr(of, f.__name__) for f in (*SOLVED, *CYCLE)}
    return {name: f for name, f in held.items() if f.__code__ is of.march.__code__}


@pytest.mark.enough("hertz", "hyperbola", "two_radii", "wedge")
@EVERY
def test_examples_of_every_function_are_right(name: str) -> None:
    """pytest finds those of functions that a module defines; bound ones are defined elsewhere."""
    of = module(name)
    runner, finder = doctest.DocTestRunner(), doctest.DocTestFinder(exclude_empty=False)
    functions = [getattr(of, n) for n in of.__all__ if not inspect.isclass(getattr(of, n))]
    for function in functions:
        (example,) = finder.find(function, function.__name__, module=False, globs=vars(of).copy())
        assert example.examples, function.__name__
        runner.run(example)
    assert runner.summarize(verbose=False).failed == 0


SIGNATURES = {
    "stick_zone": "first, second, dQ, dsigma, *, f, E_star, phi, mixed=False",
    "tension_threshold": "first, second, dQ, *, f, E_star, phi",
    "closing_tension": "first, second, dQ, *, f, E_star, phi",
    "slip_zones": "a, c, dQ, dsigma, *, f, E_star, phi, da=0.0, dc=0.0, order=1",
    "slip_error": "a, c, dQ, dsigma, *, f, E_star, phi, da=0.0, dc=0.0, order=1",
    "shear_change": "x, first, second, dQ, dsigma, *, f, E_star, phi",
    "slip_range": "x, first, second, dQ, dsigma, *, f, E_star, phi",
    "shear": "x, contact, Q, sigma, *, f, E_star, phi, dQ=0.0, dsigma=0.0",
    "march": "P, M, Q, sigma, *, f, E_star, phi, order=0",
}


def test_signatures_are_those_of_the_contract() -> None:
    def told(function: Any) -> str:
        given = inspect.signature(function)
        bare = [p.replace(annotation=p.empty) for p in given.parameters.values()]
        return str(given.replace(parameters=bare, return_annotation=given.empty))[1:-1]

    assert {name: told(function) for name, function in bound(wedge).items()} == SIGNATURES
    assert {"contact", "contact_at_tilt"} <= bound(module("two_radii")).keys()


@pytest.mark.parametrize("name", ["stick_zone", "march", "slip_zones"])
def test_a_call_that_does_not_fit_is_told_in_python_s_words(name: str) -> None:
    function = getattr(hertz, name)
    parameters = inspect.signature(function).parameters.values()
    needed = {p.name: 1.0 for p in parameters if p.default is p.empty}
    for argument in needed:
        with pytest.raises(TypeError, match=rf"\b{argument}\b"):
            function(**{k: v for k, v in needed.items() if k != argument})
    with pytest.raises(TypeError, match=rf"{name}\(\).*surplus"):
        function(**needed, surplus=1.0)


def test_functions_are_pickled_by_name() -> None:
    """As processes send them."""
    for of in (hertz, module("two_radii")):
        for name in of.__all__:
            function = getattr(of, name)
            assert function.__name__ == name
            if not inspect.isclass(function):
                assert pickle.loads(pickle.dumps(function)) is function
                assert len(pickle.dumps(function)) < 80


def test_a_body_of_one_s_own() -> None:
    """g = x**2/(2 R) once more, as a module gives it: compiled at its first call."""
    functions = {name: getattr(hertz, f"_{name}") for name in ("pressure", "state", "slope")}
    functions |= {name: getattr(hertz, f"_{name}") for name in ("series", "breaks")}
    example = hertz._BODY.example
    body = Body(functions, "here.py", example, Parameter("R", "a radius", "m"))
    assert "law" not in vars(body)
    contact = body.bound(SOLVED[0])
    assert (
        "R : array_like\n    A radius [m]." in contact.__doc__
        and "Derived from here.py." in contact.__doc__
    )
    found = contact(np.array([1.0, -1.0]), 0.25, E_star=1.0, R=1.0)
    np.testing.assert_allclose(found.a, [0.25 + 2 / math.sqrt(math.pi), np.nan], rtol=1e-13)
    assert "law" in vars(body)


def test_kernels_are_found_by_module_and_name() -> None:
    assert kernel_of("slip.zone.each_stick_zone") is kernel_of("slip.zone.each_stick_zone")
    with pytest.raises(AttributeError):
        kernel_of("inverse.each_nothing")
