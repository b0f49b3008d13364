"""Closed formulas in other languages give the numbers of the generated modules."""

import ctypes
import json
import math
import shutil
import subprocess
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sympy import Symbol

from derive import Geometry, derive_sheet, load_geometry, parameter, x
from derive.codegen.languages import LANGUAGES, code_of
from derive.errors import NoSuchName

BODIES = {  # parameters in the order of their names
    "hertz": {"R": 0.3},
    "wedge": {"phi": 0.02},
    "rounded_wedge": {"b": 0.4e-3, "phi": 0.05},
    "flat_rounded": {"R": 0.1, "b": 0.2e-3},
}
E_STAR = 60e9
A, C = 1.1e-3, 0.7e-3
LOADS = {"dQ": 2e5, "dsigma": 3e7}


def calls(name: str) -> list[tuple[str, tuple[float, ...], float]]:
    """Functions of another language, their arguments, and what the generated module gives."""
    module, own = import_module(f"generated.{name}"), BODIES[name]
    law = (E_STAR, *own.values())
    material = {"E_star": E_STAR, **own}
    found = [("tilt", (A, C, *own.values()), module.tilt(A, C, **own))]
    for function in ("load", "moment"):
        value = getattr(module, function)(A, C, **material)
        found.append((function, (A, C, *law), value))
    for place in (-0.9e-3, 0.1e-3, 0.5e-3, 2e-3):
        value = module.pressure(place, A, C, **material)
        found.append(("pressure", (place, A, C, *law), value))
    for function in ("K_N", "L_N"):
        edges = getattr(module, function)(A, C, **material)
        found += [(f"{function}_{side}", (A, C, *law), getattr(edges, side)) for side in ENDS]
    for function in ("K_T", "L_T"):
        edges = getattr(module, function)(A, C, **LOADS)
        arguments = (A, C, *LOADS.values())
        found += [(f"{function}_{side}", arguments, getattr(edges, side)) for side in ENDS]
    return found


ENDS = ("left", "right")


def nothing(name: str) -> list[tuple[str, tuple[float, ...]]]:
    """Calls whose state does not exist."""
    law = (E_STAR, *BODIES[name].values())
    return [
        ("load", (A, -2 * A, *law)),
        ("load", (A, C, -E_STAR, *law[1:])),
        ("pressure", (math.nan, A, C, *law)),
        ("pressure", (0.0, A, math.nan, *law)),
    ]


def demand_values(name: str, value_of: Any) -> None:
    for function, arguments, expected in calls(name):
        assert_allclose(value_of(function, arguments), expected, rtol=1e-11, atol=0)
    for function, arguments in nothing(name):
        assert np.isnan(value_of(function, arguments))


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
@pytest.mark.parametrize("name", BODIES)
def test_c(name: str, tmp_path: Path) -> None:
    (tmp_path / "body.c").write_text(code_of(derive_sheet(load_geometry(name)), "c"))
    flags = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC")
    subprocess.run(["cc", *flags, "body.c", "-o", "body.so", "-lm"], cwd=tmp_path, check=True)
    library = ctypes.CDLL(str(tmp_path / "body.so"))

    def value_of(function: str, arguments: tuple[float, ...]) -> float:
        called = library[f"{name}_{function}"]
        called.restype, called.argtypes = ctypes.c_double, [ctypes.c_double] * len(arguments)
        return float(called(*arguments))

    demand_values(name, value_of)


@pytest.mark.skipif(shutil.which("node") is None, reason="no JavaScript engine")
@pytest.mark.parametrize("name", ["wedge", "rounded_wedge"])
def test_javascript(name: str, tmp_path: Path) -> None:
    (tmp_path / "body.mjs").write_text(code_of(derive_sheet(load_geometry(name)), "javascript"))

    def value_of(function: str, arguments: tuple[float, ...]) -> float:
        call = f"body.{function}({', '.join(json.dumps(v) for v in arguments)})"
        run = f"import('./body.mjs').then(body => console.log({call}))"
        done = subprocess.run(
            ["node", "-e", run], cwd=tmp_path, capture_output=True, text=True, check=True
        )
        return float(done.stdout)

    demand_values(name, value_of)


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
        "if ~(E_star > 0 & R > 0 & a + c > 0), return, end",
        "value = pi*E_star.*(a + c).^2./(16*R);",
    ],
}


@pytest.mark.parametrize("language", HERTZ_LOAD)
def test_the_load_of_a_cylinder(language: str) -> None:
    """P = pi E* (a + c)**2/(16 R), as each language writes it."""
    lines = [
        line.strip() for line in code_of(derive_sheet(load_geometry("hertz")), language).split("\n")
    ]
    for line in HERTZ_LOAD[language]:
        assert line in lines


def test_julia_has_atan_of_two_arguments() -> None:
    text = code_of(derive_sheet(load_geometry("wedge")), "julia")
    assert "atan(" in text
    assert "atan2" not in text


@pytest.mark.parametrize("language", LANGUAGES)
def test_integrals_are_named_and_left_out(language: str) -> None:
    text = code_of(derive_sheet(load_geometry("catenary")), language)
    assert "Not included, because they are integrals: tilt, load, moment, pressure" in text
    assert "K_T_left" in text


@pytest.mark.parametrize(
    ("language", "name", "why"),
    [
        ("c", "register", "is reserved in code of that language"),
        ("javascript", "var", "is reserved in code of that language"),
        ("fortran", "e_star", "is the same name as 'E_star'"),
    ],
)
def test_a_name_that_a_language_has_no_room_for(language: str, name: str, why: str) -> None:
    R = parameter(name, "relative radius of curvature", unit="m")
    assert isinstance(R, Symbol)
    sheet = derive_sheet(Geometry("cylinder", g=x**2 / (2 * R)))
    with pytest.raises(NoSuchName, match=f"cylinder in {language}: '{name}' {why}"):
        code_of(sheet, language)
