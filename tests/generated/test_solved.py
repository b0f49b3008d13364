"""Bodies without a closed inverse: contact and contact_at_tilt by solving."""

from collections.abc import Iterator
from functools import cache
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.codegen.module import module_text
from derive.codegen.trial import imported
from tests.codegen.made import STUCK
from tests.derive.bodies import BODIES, VALUES, assumed, proven, sheet, value

QUICK = ["quartic"]
SLOW = ["wedge_on_parabola", "half_parabola", "flat_cornered"]
EVERY = pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)]
)
IN_LIBRARY = {"quartic", "flat_cornered"}
"""Proven whenever the package is generated; the others are proven here."""
E_STAR = VALUES["E_star"]
COUNT = 2000


@cache
def text(name: str) -> str:
    of = assumed(sheet(name)) if name in IN_LIBRARY else proven(name)
    return module_text(of, f"{name}.py")


@pytest.fixture
def body(name: str) -> Iterator[ModuleType]:
    """The generated module; its kernels are those of derive/runtime."""
    with imported(name, text(name), STUCK) as module:
        yield module


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


@pytest.mark.parametrize("name", QUICK)
def test_a_quartic_by_hand(body: ModuleType) -> None:
    """g = x^4/C at no moment: a = c and P = (E*/2) int x g'/w = (E*/2)(4/C)(3 pi/8) a^4."""
    load = 10.0 ** np.arange(-12.0, 13.0)
    found = body.contact(load, E_star=1.25, C=2.0)
    edge = np.array([float((4 * 2 * mpmath.mpf(P) / (3 * mpmath.pi * 1.25)) ** 0.25) for P in load])
    assert_allclose(found.a, edge, rtol=1e-13)
    assert_allclose(found.c, edge, rtol=1e-13)
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
    assert_allclose(alone, [field[-1] for field in found], rtol=1e-12)
