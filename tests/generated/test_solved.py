"""Bodies without a closed inverse: contact and contact_at_tilt by solving."""

import importlib.util
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.codegen.module import module_text
from derive.codegen.publish import package_files, publish
from tests.derive.bodies import BODIES, VALUES, assumed, proven, sheet, value

QUICK = ["quartic"]
SLOW = ["two_radii", "wedge_on_parabola", "half_parabola", "flat_cornered", "flat_rounded"]
EVERY = pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)]
)
IN_LIBRARY = {"quartic", "two_radii", "flat_cornered", "flat_rounded"}
"""Proven whenever the package is generated; the others are proven here."""
E_STAR = VALUES["E_star"]
COUNT = 20_000


@cache
def text(name: str) -> str:
    of = assumed(sheet(name)) if name in IN_LIBRARY else proven(name)
    return module_text(of, f"{name}.py")


@pytest.fixture
def body(name: str, tmp_path: Path) -> Iterator[ModuleType]:
    """The generated module, imported from a package of its own."""
    package = f"package_of_{name}"
    publish(package_files({name: text(name)}), tmp_path / package)
    sys.path.insert(0, str(tmp_path))
    try:
        yield importlib.import_module(f"{package}.{name}")
    finally:
        sys.path.remove(str(tmp_path))
        for held in [m for m in sys.modules if m.partition(".")[0] == package]:
            del sys.modules[held]


def constants(name: str) -> dict[str, float]:
    return {q.name: VALUES[q.name] for q in sheet(name).geometry.parameters}


def states(name: str, module: ModuleType) -> tuple[Any, Any, Any]:
    """Contacts from 1e-6 to 1e6 m wide, central and not, that carry a load; and the load."""
    rng = np.random.default_rng(11)
    half = 10.0 ** rng.uniform(-6, 6, COUNT)
    mid = half * rng.uniform(-0.9, 0.9, COUNT) * 10.0 ** rng.choice([-3.0, 0.0, 1.0], COUNT)
    load = module.load(half - mid, half + mid, E_star=E_STAR, **constants(name))
    touching = load > 0
    assert np.count_nonzero(touching) > COUNT // 4
    return (half - mid)[touching], (half + mid)[touching], load[touching]


@pytest.mark.enough("flat_rounded", "quartic", "half_parabola")
@EVERY
def test_no_load_case_is_lost_and_each_is_met(name: str, body: ModuleType) -> None:
    own = {"E_star": E_STAR, **constants(name)}
    a, c, load = states(name, body)
    moment, alpha = body.moment(a, c, **own), body.tilt(a, c, **constants(name))
    reach = np.maximum(a + c, np.abs(moment / load))
    for found in (body.contact(load, moment, **own), body.contact_at_tilt(load, alpha, **own)):
        assert_allclose(body.load(found.a, found.c, **own), load, rtol=1e-9)
        again = body.moment(found.a, found.c, **own)
        assert np.all(np.abs(again - moment) <= 1e-8 * load * reach)


@EVERY
def test_a_state_meets_the_formulas_of_the_sheet(name: str, body: ModuleType) -> None:
    """At one load case, in 30 digits, from the sheet and not from the generated code."""
    own = {"E_star": E_STAR, **constants(name)}
    left, right = BODIES[name].contacts[0]
    load, moment = (value(name, f, a=left, c=right) for f in ("load", "moment"))
    found = body.contact(float(load), float(moment), **own)
    assert_allclose([found.a, found.c], [left, right], rtol=1e-13)
    assert_allclose(found.alpha, float(value(name, "tilt", a=left, c=right)), rtol=1e-12)
    alpha = value(name, "tilt", a=left, c=right)
    found = body.contact_at_tilt(float(load), float(alpha), **own)
    assert_allclose([found.a, found.c], [left, right], rtol=1e-12)


def test_a_quartic_by_hand(tmp_path: Path) -> None:
    """g = x^4/C at no moment: a = c and P = (E*/2) int x g'/w = (E*/2)(4/C)(3 pi/8) a^4."""
    publish(package_files({"quartic": text("quartic")}), tmp_path / "by_hand")
    spec = importlib.util.spec_from_file_location("by_hand", tmp_path / "by_hand" / "__init__.py")
    assert spec is not None
    sys.path.insert(0, str(tmp_path))
    try:
        module = importlib.import_module("by_hand.quartic")
    finally:
        sys.path.remove(str(tmp_path))
    load = 10.0 ** np.arange(-12.0, 13.0)
    found = module.contact(load, E_star=1.25, C=2.0)
    edge = np.array([float((4 * 2 * mpmath.mpf(P) / (3 * mpmath.pi * 1.25)) ** 0.25) for P in load])
    assert_allclose(found.a, edge, rtol=1e-14)
    assert_allclose(found.c, edge, rtol=1e-14)
    assert_allclose(found.alpha, 0.0, atol=1e-15 * edge[-1] ** 3)


@EVERY
def test_states_that_do_not_exist_are_nan_and_harm_nobody(name: str, body: ModuleType) -> None:
    own = {"E_star": E_STAR, **constants(name)}
    load = np.array([1.0, -1.0, 0.0, np.nan, np.inf, 2.0])
    with np.errstate(all="raise"):
        found = body.contact(load, 0.25, **own)
        tilted = body.contact_at_tilt(load, -0.0625, **own)
    for state in (found, tilted):
        for field in state:
            assert np.isnan(field).tolist() == [False, True, True, True, True, False]
    alone = body.contact(2.0, 0.25, **own)
    assert_allclose(alone, [field[-1] for field in found], rtol=1e-14)


@EVERY
def test_scalars_stay_scalars_and_everything_broadcasts(name: str, body: ModuleType) -> None:
    own = {"E_star": E_STAR, **constants(name)}
    assert all(type(v) is np.float64 for v in body.contact(1.0, 0.25, **own))
    lists = {key: np.array([v, 2 * v])[:, None] for key, v in own.items()}
    found = body.contact(np.array([1.0, 2.0, 4.0]), 0.25, **lists)
    assert found.a.shape == found.c.shape == found.alpha.shape == (2, 3)
    alone = body.contact(4.0, 0.25, **{key: 2 * v for key, v in own.items()})
    assert_allclose([field[1, 2] for field in found], alone, rtol=1e-13)
    assert body.contact(np.zeros((0, 3)), 0.25, **own).a.shape == (0, 3)
