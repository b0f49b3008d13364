"""Random points: inside the assumptions, on all sides, and the same on every machine."""

import random
from functools import cache

import mpmath
import pytest
from mpmath import mpf
from sympy import Integral, Symbol, symbols

from derive.proof.points import Point, contacts, holds, loads, numeric
from derive.proof.verdict import POINTS
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, f, x
from tests.derive.bodies import EACH, sheet


@cache
def drawn(name: str) -> list[Point]:
    """Contacts of one body, drawn once."""
    return contacts(sheet(name))


@pytest.mark.enough("hertz", "unequal_wedge", "flat_rounded")
@pytest.mark.parametrize("name", EACH)
@pytest.mark.slow
def test_contacts_meet_every_assumption_and_lie_on_all_sides(name: str) -> None:
    body, found = sheet(name), drawn(name)
    assert len(found) == POINTS
    for sides in (
        [point[a] - point[c] for point in found],
        [point[dsigma] for point in found],
        [point[x] - (point[c] - point[a]) / 2 for point in found],
    ):
        assert sum(side > 0 for side in sides) >= POINTS // 5
        assert sum(side < 0 for side in sides) >= POINTS // 5
    free = [q.symbol for q in body.geometry.parameters if q.symbol not in body.geometry.slope.least]
    assert all(len({point[s] for point in found}) == POINTS for s in (E_star, *free))
    for point in found:
        assert holds(body["pressure"].conditions, point)
        assert -point[a] < point[x] < point[c]
        assert all(point[s] > 0 for s in (E_star, *(q.symbol for q in body.geometry.parameters)))
        assert point[dQ] >= 0
        assert 0.25 <= point[f] <= 0.75


@pytest.mark.parametrize("name", ["hertz", "wedge", "unequal_wedge", "shifted_wedge"])
def test_loads_meet_every_assumption_and_push_both_ways(name: str) -> None:
    body = sheet(name)
    for formula, given in (("contact_a", M), ("contact_at_tilt_a", alpha)):
        found = list(loads(body, body[formula]))
        assert len(found) == POINTS
        assert all(point[P] > 0 for point in found)
        assert all(holds(body[formula].conditions, point) for point in found)
        assert {mpmath.sign(point[given]) for point in found} == {-1, 1}


@pytest.mark.parametrize("edge", [a, c])
def test_a_power_has_no_value_beyond_its_break_and_needs_none(edge: Symbol) -> None:
    """int (|x| - b)**(k - 2) dx from a break at |x| = b to an edge is reach**(k - 1)/(k - 1).

    The points have more digits than they are asked with.
    """
    b, k = symbols("b k", positive=True)
    left = Integral((-(b + x)) ** k / (b + x) ** 2, (x, -a, -b))
    right = Integral((-(b - x)) ** k / (b - x) ** 2, (x, b, c))
    value = numeric(left if edge == a else right)
    rng = random.Random(0)
    for _ in range(6):
        with mpmath.workdps(40):
            reach, rest, place = (mpf(2) ** rng.uniform(-2, 2) for _ in range(3))
            power = mpf(rng.uniform(1.4, 1.9))
            point: Point = {b: place, k: power, a: rest - place, c: rest - place}
            point[edge] = place + reach
            wanted = reach ** (power - 1) / (power - 1)
        assert mpmath.almosteq(value(point), wanted, rel_eps=mpf(10) ** -13)
