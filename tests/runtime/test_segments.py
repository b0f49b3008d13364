"""The functions of the parts of a contact against their definitions to 40 digits and more."""

from collections.abc import Callable, Iterator
from random import Random
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import cos, mpf, sin

from generated.runtime import segments

DIGITS = 90
"""So many that differences of the definitions keep 40."""


def angle(rng: Random) -> float:
    """From 0 to pi, often close to one of both."""
    small = 10 ** rng.uniform(-9, 0)
    return rng.choice([small, rng.uniform(0, np.pi), np.pi - small])


def halves(rng: Random) -> tuple[mpf, mpf, mpf]:
    """Half the angles of a part's ends and of a place; some parts are narrow, some places near."""
    low, high = sorted(mpf(angle(rng)) / 2 for _ in range(2))
    if rng.random() < 0.4:
        high = low + min(low, mpmath.pi / 2 - low) * mpf(10) ** rng.uniform(-9, -0.1)
    place = mpf(angle(rng)) / 2
    if rng.random() < 0.5:
        place = high + (high - low) * rng.choice([-1, 1]) * mpf(10) ** rng.uniform(-6, 2)
    if not 1e-6 < place < mpmath.pi / 2 - 1e-6:
        place = (low + high) / 2
    return low, high, place


def level(end: mpf, f: mpf) -> mpf:
    """The logarithm of a kink at half an angle `end`, at the place f."""
    return mpmath.log(abs(sin(end + f) / sin(end - f))) / 2


# ------------------------------------------------------------------ what is called, what is right

Case = tuple[Any, mpf, mpf]
"""What a function gives, what it should give, and the size by which an error is judged."""


def of_an_angle(rng: Random) -> Iterator[Case]:
    t = angle(rng)
    yield segments.segment(t), (true := mpf(t) - sin(mpf(t)) * cos(mpf(t))), true
    yield segments.involute(t), (true := sin(mpf(t)) - mpf(t) * cos(mpf(t))), true
    y = min(t, 0.5)
    yield segments.excess(y), (true := mpmath.atanh(mpf(y)) - mpf(y)), true


def carried(rng: Random) -> Iterator[Case]:
    """s = mid - (h/2) cos(2 v): w ds = (h**2/2) sin(2 v)**2 dv and w/A ds = 2 h cos(v)**2 dv."""
    low, high, _ = halves(rng)
    t = float(2 * (high - low))
    ends = [g(v) for v in (low, high) for g in (sin, cos)]
    sums = [(2 * v - sin(4 * v) / 2, -(sin(2 * v) ** 3), v + sin(2 * v) / 2) for v in (low, high)]
    area, arm, weight = (upper - lower for lower, upper in zip(*sums, strict=True))
    yield segments.part_area(t, float(sin(low + high))), area, area
    yield segments.part_arm(t, *map(float, ends)), arm, area
    yield segments.part_weight(t, float(ends[1] * ends[3])), weight, weight


def pressed_at_an_edge(rng: Random) -> Iterator[Case]:
    _, e, f = halves(rng)
    t = float(2 * e)
    e = mpf(t) / 2
    true = e * sin(f) * cos(f) + (sin(e) ** 2 - sin(f) ** 2) * level(e, f)
    yield segments.end_pressure(t, float(sin(f)), float(cos(f))), true, true * 7  # 2e-14


def pressed_between_kinks(rng: Random) -> Iterator[Case]:
    low, high, f = halves(rng)
    squares = [sin(end) ** 2 - sin(f) ** 2 for end in (low, high)]
    true = (high - low) * sin(2 * f) / 2 + squares[1] * level(high, f) - squares[0] * level(low, f)
    places = [g(v) for v in (low, high, f) for g in (sin, cos)]
    yield segments.part_pressure(*map(float, (2 * (high - low), *squares, *places))), true, true


def second_terms(rng: Random) -> Iterator[Case]:
    low, high, _ = halves(rng)
    low *= rng.random() > 0.25  # some begin at the edge
    low_sum, high_sum = (v / 2 - sin(2 * v) / 4 + 2 * (mpmath.tan(v) - v) for v in (low, high))
    true, near, far = high_sum - low_sum, sin(low) * sin(high), cos(low) * cos(high)
    yield segments.second_term(float(2 * (high - low)), float(near), float(far)), true, true


FUNCTIONS = (of_an_angle, carried, pressed_at_an_edge, pressed_between_kinks, second_terms)


@pytest.mark.parametrize("of", FUNCTIONS)
def test_functions_of_a_part_keep_their_digits(of: Callable[[Random], Iterator[Case]]) -> None:
    rng = Random(7)
    with mpmath.workdps(DIGITS):
        for _ in range(400):
            for found, true, size in of(rng):
                assert abs(mpf(float(found)) - true) < 3e-15 * abs(size)


def test_at_edges_on_kinks_and_beyond() -> None:
    """An angle of 60 degrees has a half of 30, whose tangent is 1/sqrt(3)."""
    assert segments.edge_angle(1.0, 3.0) == pytest.approx(np.pi / 3, rel=1e-15)
    assert segments.edge_angle(-1.0, 3.0) == 0 and segments.edge_angle(2.0, 0.0) == np.pi
    assert segments.end_pressure(1.0, 0.0, 1.0) == segments.end_pressure(1.0, 1.0, 0.0) == 0
    assert segments.end_pressure(0.0, 0.6, 0.8) == 0
    assert segments.second_term(0.0, 0.0, 0.0) == segments.second_term(0.7, 0.6, 0.0) == 0
    assert segments.root_ratio(-1.0, 1.0) == segments.root_ratio(1.0, -1.0) == 0
    assert segments.root_ratio(9.0, 4.0) == 1.5
    on, near = (segments.end_pressure(1.0, np.sin(v), np.cos(v)) for v in (0.5, 0.5 + 1e-12))
    assert abs(on / near - 1) < 1e-10
    at, beside = (
        segments.part_pressure(0.6, 0.0 + d, 0.3 + d, 0.6, 0.8, 0.8, 0.6, 0.6, 0.8)
        for d in (0.0, 1e-12)
    )
    assert abs(at / beside - 1) < 1e-10
