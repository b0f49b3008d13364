"""Closed formulas in other languages give the numbers of the generated modules."""

import ctypes
import json
import math
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from numpy.testing import assert_allclose
from sympy import Abs, Expr, Integer, Max, exp

from derive import Geometry, derive_sheet, parameter, x
from derive.codegen.languages import LANGUAGES, code_of
from derive.command.errors import NoSuchName
from derive.sheet.formulas import FormulaSheet
from tests.derive.bodies import of_library

BODIES = {  # parameters in the order of their names
    **{"hertz": {"R": 0.3}, "wedge": {"phi": 0.02}},
    **{"rounded_wedge": {"b": 0.4e-3, "phi": 0.05}, "flat_rounded": {"R": 0.1, "b": 0.2e-3}},
}
E_STAR = 60e9
A, C = 1.1e-3, 0.7e-3
LOADS = {"dQ": 2e5, "dsigma": 3e7}


def calls(name: str) -> list[tuple[str, tuple[float, ...], float]]:
    """Functions of another language, their arguments, and what the generated module gives."""
    module, own = import_module(f"generated.{name}"), BODIES[name]
    law, material = (E_STAR, *own.values()), {"E_star": E_STAR, **own}
    found = [("tilt", (A, C, *own.values()), module.tilt(A, C, **own))]
    for function in ("load", "moment"):
        found.append((function, (A, C, *law), getattr(module, function)(A, C, **material)))
    small = (A / 4, C / 4)  # within the kinks of the rounded wedge
    for x_, a_, c_ in (*((x_, A, C) for x_ in (-0.9e-3, 0.1e-3, 0.5e-3, 2e-3)), (2e-3, *small)):
        value = module.pressure(x_, a_, c_, **material)
        found.append(("pressure", (x_, a_, c_, *law), value))
    for function in ("K_N", "L_N", "K_T", "L_T"):
        given = material if function.endswith("N") else LOADS
        edges = getattr(module, function)(A, C, **given)
        passed = (A, C, *(law if given is material else LOADS.values()))
        found += [(f"{function}_{s}", passed, getattr(edges, s)) for s in ("left", "right")]
    return found


Call = tuple[str, tuple[float, ...]]


def demand_values(name: str, values_of: Callable[[list[Call]], list[float]]) -> None:
    known, law = calls(name), (E_STAR, *BODIES[name].values())
    nowhere: list[Call] = [  # states that do not exist
        *(("load", (A, -2 * A, *law)), ("load", (A, C, -E_STAR, *law[1:]))),
        *(("pressure", (math.nan, A, C, *law)), ("pressure", (0.0, A, math.nan, *law))),
    ]
    found = values_of([*((function, arguments) for function, arguments, _ in known), *nowhere])
    expected = [*(value for *_, value in known), *[math.nan] * len(nowhere)]
    assert_allclose(found, expected, rtol=1e-11, atol=0)


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
@pytest.mark.parametrize("name", ["wedge", "rounded_wedge"])
def test_c(name: str, tmp_path: Path) -> None:
    (tmp_path / "body.c").write_text(code_of(of_library(name), "c"))
    flags = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC")
    subprocess.run(["cc", *flags, "body.c", "-o", "body.so", "-lm"], cwd=tmp_path, check=True)
    library = ctypes.CDLL(str(tmp_path / "body.so"))

    def value_of(function: str, arguments: tuple[float, ...]) -> float:
        called = library[f"{name}_{function}"]
        called.restype, called.argtypes = ctypes.c_double, [ctypes.c_double] * len(arguments)
        return float(called(*arguments))

    demand_values(name, lambda asked: [value_of(*call) for call in asked])


@pytest.mark.skipif(shutil.which("node") is None, reason="no JavaScript engine")
@pytest.mark.parametrize("name", ["wedge", "rounded_wedge"])
def test_javascript(name: str, tmp_path: Path) -> None:
    (tmp_path / "body.mjs").write_text(code_of(of_library(name), "javascript"))

    def values_of(asked: list[Call]) -> list[float]:
        listed = (f"body.{of}({', '.join(map(json.dumps, given))})" for of, given in asked)
        run = f"import('./body.mjs').then(body => console.log([{', '.join(listed)}].join(' ')))"
        done = subprocess.run(
            ["node", "-e", run], cwd=tmp_path, capture_output=True, text=True, check=True
        )
        return [float(value) for value in done.stdout.split()]

    demand_values(name, values_of)


HERTZ_LOAD = {
    "fortran": [
        "elemental function load(a, c, E_star, R) result(value)",
        "if (.not. (E_star > 0 .and. R > 0 .and. a + c > 0)) return",
        "value = (1.0d0/16.0d0)*pi*E_star*(a + c)**2/R",
    ],
    "julia": [
        "function load(a, c, E_star, R)",
        "(E_star > 0 && R > 0 && a + c > 0) || return NaN",
        "return pi * E_star .* (a + c) .^ 2 ./ (16 * R)",
    ],
    "matlab": [
        "function value = load(a, c, E_star, R)",
        "[valid, a, c, E_star, R] = valid_states(E_star > 0 & R > 0 & a + c > 0, a, c, E_star, R);",
        "value = NaN(size(valid));",
        "value(valid) = pi*E_star.*(a + c).^2./(16*R);",
    ],
}


@pytest.mark.parametrize("language", HERTZ_LOAD)
def test_the_load_of_a_cylinder(language: str) -> None:
    """P = pi E* (a + c)**2/(16 R), as each language writes it."""
    text = code_of(of_library("hertz"), language)
    assert {*HERTZ_LOAD[language]} <= {line.strip() for line in text.split("\n")}


@pytest.mark.parametrize("language", LANGUAGES)
def test_integrals_are_named_and_left_out(language: str) -> None:
    text = code_of(of_library("catenary"), language)
    assert "tilt, load, moment, pressure" in text
    assert "K_T_left" in text


def names_in(text: str) -> set[str]:
    """All names in the code of a Fortran file."""
    return {*re.findall(r"\b[A-Za-z]\w*", re.sub("!.*", "", text))}


def test_steps_in_fortran_avoid_the_names_of_parameters() -> None:
    """The angle theta_1 and the logarithm L_1 of a kink make way for Theta_1 and l_1."""
    R = parameter("Theta_1", "radius of the edges", unit="m")
    b = parameter("l_1", "half-width of the flat", unit="m")
    sheet = derive_sheet(Geometry("pad", g=Max(0, Abs(x) - b) ** 2 / (2 * R)))
    names = names_in(code_of(sheet, "fortran"))
    assert {"Theta_1", "l_1", "theta_2", "L_2"} <= names
    assert len({name.lower() for name in names}) == len(names)


@cache
def cylinder(factor: Expr) -> FormulaSheet:
    """The sheet of a factor times x**2/R."""
    R = parameter("R", "relative radius of curvature", unit="m")
    return derive_sheet(Geometry("cylinder", g=factor * x**2 / R))


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_number_e_is_not_the_modulus(language: str) -> None:
    assert not re.search(r"\d_star", code_of(cylinder(exp(1) / 2), language))


def test_numbers_too_long_for_an_integer_are_reals_in_fortran() -> None:
    """P = pi E* (a + c)**2/(16 R) with R/(2e12) in place of R."""
    text = code_of(cylinder(Integer(10) ** 12), "fortran")
    assert "value = 125000000000.0d0*pi*E_star*(a + c)**2/R" in text


@pytest.mark.parametrize(
    ("language", "name", "why"),
    [
        *(("c", "register", ""), ("c", "fabs", ""), ("javascript", "var", "")),
        *(("matlab", "valid", ""), ("fortran", "K_N_left", "")),
        *(("fortran", "e_star", ".*'E_star'"), ("fortran", "F", ".*'f'")),
        *(("fortran", "Sqrt", ".*'sqrt'"), ("fortran", "k_n_left", ".*'K_N_left'")),
    ],
)
def test_a_name_that_a_language_has_no_room_for(language: str, name: str, why: str) -> None:
    """For the radius of a cylinder, whose formulas need not be derived once more."""
    R = parameter(name, "relative radius of curvature", unit="m")
    sheet = replace(of_library("hertz"), geometry=Geometry("cylinder", g=x**2 / (2 * R)))
    with pytest.raises(NoSuchName, match=f"cylinder in {language}: '{name}'{why}"):
        code_of(sheet, language)
