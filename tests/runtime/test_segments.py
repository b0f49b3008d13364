"""The functions of the parts of a contact against their definitions to 40 digits and more."""

from collections.abc import Callable, Iterator
from random import Random

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from generated.runtime import segments

DIGITS = 90
"""So many that differences of the definitions keep 40."""


def angles(rng: Random) -> float:
    """From 0 to pi, often close to one of both."""
    small = 10 ** rng.uniform(-9, 0)
    return rng.choice([small, rng.uniform(0, np.pi), np.pi - small])


def halves(rng: Random) -> tuple[mpf, mpf, mpf]:
    """Half the angles of a part's ends and of a place; some parts are narrow, some places near."""
    low, high = sorted(mpf(angles(rng)) / 2 for _ in range(2))
    if rng.random() < 0.4:
        high = low + min(low, mpmath.pi / 2 - low) * mpf(10) ** rng.uniform(-9, -0.1)
    place = mpf(angles(rng)) / 2
    if rng.random() < 0.5:
        place = high + (high - low) * rng.choice([-1, 1]) * mpf(10) ** rng.uniform(-6, 2)
    if not 1e-6 < place < mpmath.pi / 2 - 1e-6:
        place = (low + high) / 2
    return low, high, place


def worst(cases: Iterator[tuple[float, mpf]]) -> float:
    return max(float(abs(mpf(float(found)) / true - 1)) for found, true in cases)


OF_AN_ANGLE: dict[str, Callable[[mpf], mpf]] = {
    "segment": lambda t: t - mpmath.sin(t) * mpmath.cos(t),
    "involute": lambda t: mpmath.sin(t) - t * mpmath.cos(t),
    "excess": lambda y: mpmath.atanh(y) - y,
}


@pytest.mark.parametrize("name", OF_AN_ANGLE)
def test_functions_of_an_angle_keep_their_digits(name: str) -> None:
    rng, function = Random(1), getattr(segments, name)
    drawn = [angles(rng) for _ in range(1000)]
    given = [t for t in drawn if name != "excess" or t <= 0.5]
    with mpmath.workdps(DIGITS):
        assert worst((function(t), OF_AN_ANGLE[name](mpf(t))) for t in given) < 1e-15
    assert function(0.0) == 0


def test_what_a_part_between_kinks_carries() -> None:
    """s = mid - (h/2) cos(2 v): w ds = (h**2/2) sin(2 v)**2 dv and w/A ds = 2 h cos(v)**2 dv."""
    rng = Random(7)

    def integrals(v: mpf) -> tuple[mpf, ...]:
        """From the left edge; of w ds, of w (s - mid) ds and of w/A ds."""
        double = mpmath.sin(2 * v)
        return 2 * v - mpmath.sin(4 * v) / 2, -(double**3), v + double / 2

    with mpmath.workdps(DIGITS):
        for _ in range(1000):
            low, high, _ = halves(rng)
            t = float(2 * (high - low))
            ends = [g(v) for v in (low, high) for g in (mpmath.sin, mpmath.cos)]
            across, far = float(mpmath.sin(low + high)), float(ends[1] * ends[3])
            pairs = zip(integrals(high), integrals(low), strict=True)
            area, arm, weight = (upper - lower for upper, lower in pairs)
            assert abs(segments.part_area(t, across) / area - 1) < 3e-15
            assert abs(segments.part_arm(t, *map(float, ends)) - arm) < 3e-15 * area
            assert abs(segments.part_weight(t, far) / weight - 1) < 3e-15


def test_the_angle_of_a_part_at_an_edge() -> None:
    """An angle of 60 degrees has a half of 30, whose tangent is 1/sqrt(3)."""
    assert segments.edge_angle(1.0, 3.0) == pytest.approx(np.pi / 3, rel=1e-15)
    assert segments.edge_angle(-1.0, 3.0) == 0 and segments.edge_angle(2.0, 0.0) == np.pi


def test_the_pressure_of_a_part_at_an_edge() -> None:
    rng = Random(2)

    def cases() -> Iterator[tuple[float, mpf]]:
        for _ in range(1000):
            _, e, f = halves(rng)
            sine, cosine, t = mpmath.sin(f), mpmath.cos(f), float(2 * e)
            e = mpf(t) / 2
            level = mpmath.log(abs(mpmath.sin(e + f) / mpmath.sin(e - f))) / 2
            true = e * sine * cosine + (mpmath.sin(e) ** 2 - sine**2) * level
            yield segments.end_pressure(t, float(sine), float(cosine)), true

    with mpmath.workdps(DIGITS):
        assert worst(cases()) < 2e-14  # where x lies by 1e-9 of its angle beside the kink


def test_the_pressure_of_a_part_between_kinks() -> None:
    rng = Random(3)

    def cases() -> Iterator[tuple[float, mpf]]:
        for _ in range(1000):
            low, high, f = halves(rng)
            squares = [mpmath.sin(end) ** 2 - mpmath.sin(f) ** 2 for end in (low, high)]
            first, second = (
                mpmath.log(abs(mpmath.sin(end + f) / mpmath.sin(end - f))) / 2
                for end in (low, high)
            )
            true = (high - low) * mpmath.sin(2 * f) / 2 + squares[1] * second - squares[0] * first
            places = [g(v) for v in (low, high, f) for g in (mpmath.sin, mpmath.cos)]
            yield segments.part_pressure(*map(float, (2 * (high - low), *squares, *places))), true

    with mpmath.workdps(DIGITS):
        assert worst(cases()) < 3e-15


def test_the_second_term_of_the_pressure() -> None:
    rng, function = Random(4), segments.second_term

    def antiderivative(v: mpf) -> mpf:
        return v / 2 - mpmath.sin(2 * v) / 4 + 2 * (mpmath.tan(v) - v)

    def cases() -> Iterator[tuple[float, mpf]]:
        for number in range(1000):
            low, high, _ = halves(rng)
            low *= number % 4 > 0  # some begin at the edge
            near, far = mpmath.sin(low) * mpmath.sin(high), mpmath.cos(low) * mpmath.cos(high)
            found = function(float(2 * (high - low)), float(near), float(far))
            yield found, antiderivative(high) - antiderivative(low)

    with mpmath.workdps(DIGITS):
        assert worst(cases()) < 3e-15
    assert function(0.0, 0.0, 0.0) == function(0.7, 0.6, 0.0) == 0


def test_nothing_presses_at_the_edges_and_beyond() -> None:
    assert segments.end_pressure(1.0, 0.0, 1.0) == segments.end_pressure(1.0, 1.0, 0.0) == 0
    assert segments.end_pressure(0.0, 0.6, 0.8) == 0
    ends = (0.6, 0.8, 0.8, 0.6)
    for sine, cosine in ((0.0, 1.0), (1.0, 0.0)):
        offsets = (0.36 - sine**2, 0.64 - sine**2)
        assert segments.part_pressure(0.5, *offsets, *ends, sine, cosine) == 0
    assert segments.root_ratio(-1.0, 1.0) == segments.root_ratio(1.0, -1.0) == 0
    assert segments.root_ratio(9.0, 4.0) == 1.5


def test_a_place_on_a_kink_has_a_pressure() -> None:
    on, near = (segments.end_pressure(1.0, np.sin(v), np.cos(v)) for v in (0.5, 0.5 + 1e-12))
    assert abs(on / near - 1) < 1e-10
    at, beside = (
        segments.part_pressure(0.6, 0.0 + d, 0.3 + d, 0.6, 0.8, 0.8, 0.6, 0.6, 0.8)
        for d in (0.0, 1e-12)
    )
    assert abs(at / beside - 1) < 1e-10
