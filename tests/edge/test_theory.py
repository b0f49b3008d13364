"""The matching at an edge, against the two conditions of a contact, and the runtime's formulas."""

from sympy import Rational, expand, symbols

from derive.symbols import f
from derive.theory import edge, slip
from generated.runtime.edge.near import HalfCycle

K, L, N, K_T, L_T, N_T, D, move = symbols("K L N K_T L_T N_T D move")


def test_the_slip_zone_is_that_of_a_contact_without_end() -> None:
    """theory.slip's near over pi sqrt(h), h -> oo: the terms without a power of 1/h."""
    condition, _ = edge.matched([((f * K, f * L, f * N), D)] * 2, (K_T, L_T, N_T))
    width = symbols("width", positive=True)
    whole = expand(slip.near((K, L, N), D, width, 3) / (slip.pi * width ** Rational(1, 2)))
    limit = sum(term for term in whole.as_ordered_terms() if not term.has(width))
    held = expand(condition + K_T + L_T * D / 2 + Rational(3, 8) * N_T * D**2)
    assert expand(held - 2 * f * limit) == 0


def test_the_runtime_obeys_the_condition() -> None:
    """With K_T > 0 and a moving edge, to rounding; R is the polynomial of the stick zone."""
    half = HalfCycle(2.0, 0.2, 0.05, 0.7, 0.3, 0.5)
    before, d = (half.K_N_at(half.da), half.L_N), half.zone()
    now = (half.f * half.K_N, half.f * half.L_N), D
    then = [half.f * C for C in before], D - half.da
    condition, R = edge.matched([now, then], (half.K_T, half.L_T))
    assert abs(condition.subs(D, d)) < 1e-15
    assert all(
        abs(one.subs(D, d) - other) < 1e-14 for one, other in zip(R, half.stuck(), strict=True)
    )


def test_what_a_pressure_was_before_its_edge_advanced() -> None:
    """K_N = K + L u + N u**2 at an edge that was still u behind, where u**k gives p a share of
    s**(k + 1/2): int_0^1 v**k/(2 sqrt(1 - v)) dv = 1, 2/3, 8/15."""
    second, third = Rational(2, 3), Rational(8, 15)
    now = (K, second * L, third * N)
    before = (K + L * move + N * move**2, second * (L + 2 * N * move), third * N)
    pairs = zip(edge.grown(now, move), before, strict=True)
    assert [expand(a - b) for a, b in pairs] == [0, 0, 0]
