"""K_N and the series at an edge: against limits of p."""

import mpmath
import pytest
from mpmath import mpf

from derive.theory.edges import Edge, pressure_series
from tests.derive.bodies import CASES, close, number, sheet, value

pytestmark = pytest.mark.slow

ALL = pytest.mark.parametrize(("name", "left", "right"), CASES)


def near(name: str, edge: Edge, step: mpf, left: float, right: float) -> mpf:
    """p at a distance `step` inward."""
    at = -mpf(left) if edge is Edge.LEFT else mpf(right)
    return value(name, "pressure", x=at + edge.inward * step, a=left, c=right)


@ALL
@pytest.mark.parametrize("edge", Edge, ids=lambda e: e.name.lower())
def test_K_N_and_L_N_are_what_the_pressure_tends_to(
    name: str, left: float, right: float, edge: Edge
) -> None:
    """p = sqrt(s)(K + L s + ...): two evaluations at s and s/2 tell K and L apart."""
    side = edge.name.lower()
    with mpmath.workdps(60):
        step = mpf("1e-20")
        full, half = (near(name, edge, d, left, right) / mpmath.sqrt(d) for d in (step, step / 2))
        first, second = 2 * half - full, 2 * (full - half) / step
    assert close(value(name, f"K_N_{side}", a=left, c=right), first)
    assert close(value(name, f"L_N_{side}", a=left, c=right), second, digits=15, scale=1)


@pytest.mark.parametrize("edge", Edge, ids=lambda e: e.name.lower())
@pytest.mark.parametrize("name", ["shifted_wedge", "two_radii"])
def test_four_terms_leave_an_error_of_the_fifth(name: str, edge: Edge) -> None:
    """p - (four terms) ~ s^(9/2): a tenth of s leaves 10^-4.5 of it."""
    frame, at = sheet(name).frame, {"a": mpf(2), "c": mpf("1.5")}
    terms = [number(frame.flat(term), **at) for term in pressure_series(frame, edge, 4)]

    def rest(step: mpf) -> mpf:
        series = sum(term * step**n for n, term in enumerate(terms))
        return near(name, edge, step, at["a"], at["c"]) - mpmath.sqrt(step) * series

    with mpmath.workdps(60):
        ratio = rest(mpf("1e-5")) / rest(mpf("1e-6"))
    assert abs(mpmath.log10(ratio) - mpf("4.5")) < mpf("1e-4")
