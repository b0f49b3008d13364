"""The runtime's formulas at an edge against the conditions of a whole contact, theory.slip."""

from sympy import Rational, expand, oo, pi, symbols

from derive.symbols import h
from derive.theory import slip
from generated.runtime.edge.near import HalfCycle

K, L, D, width, rate = symbols("K L D width rate", positive=True)


def test_the_slip_zone_is_that_of_a_contact_without_end() -> None:
    """theory.slip's near over pi sqrt(h), h -> oo, of both contacts; a moving edge."""
    half = HalfCycle(2.0, 0.2, 0.05, 0.7, 0.3, 0.5)
    d = half.zone()
    whole = expand(slip.near((K, L), D, width, 2) / (pi * width ** Rational(1, 2)))
    limit = whole.limit(width, oo)
    contacts = (half.K_N, half.L_N, d), (half.K_N_at(half.da), half.L_N, d - half.da)
    carried = [float(limit.subs(dict(zip((K, L, D), each, strict=True)))) for each in contacts]
    assert abs(half.f * sum(carried) - half.K_T - half.L_T * d / 2) < 1e-15


def test_a_known_width_adds_its_term_to_the_load_that_drives_slip() -> None:
    """f K_N d**2/(8 h) in all if the edge stays and the other one does not slip."""
    (c_1,) = slip.ratios("left", 2)
    condition = slip.conditions(2)[0].subs({slip.d_right: 0, slip.D_right: 0, c_1: 0})
    found = condition.series(slip.d_left, 0, 3).removeO().subs(slip.D_left, slip.d_left)
    L_T = -1 / (2 * slip.width)  # over K_T; K_T is about f K_N d
    assert expand(found + (L_T / 2 + Rational(1, 8) / slip.width) * slip.d_left**2) == 0
    half = HalfCycle(2.0, 1e-3, 0.0, 0.0, 0.0, 0.5, 0.7)
    d = half.zone()
    assert abs(half.f * half.K_N * (d - d**2 / (8 * 0.7)) - half.K_T) < 1e-18


def test_what_a_pressure_was_before_its_edge_advanced() -> None:
    """K_N falls by 3/2 L_N times the way: the second coefficient of theory.slip, h -> oo."""
    second = slip.pressure_next(rate, 0, K).subs(h, width).limit(width, oo)
    half = HalfCycle(2.0, 0.2, 0.05, float(second.subs(rate, 1)), 0.3, 0.5)
    assert half.K_N_at(0.1) == 2.0 - 0.1
