"""What the references say is right by hand, and by routes of their own."""

import mpmath
import pytest
from mpmath import mpf

from derive.proof.balls import ball
from derive.proof.points import numeric
from tests.accuracy import partial_slip
from tests.accuracy.definitions import formula
from tests.accuracy.quadrature import integrals
from tests.accuracy.reference import sheet_of

pytestmark = pytest.mark.slow

HERTZ = {"E_star": 1.25, "R": 1.5, "f": 0.5}
EDGES = {"a": 1.5, "c": 1.25}


def close(value: mpf, expected: mpf, digits: int = 25) -> bool:
    with mpmath.workdps(60):
        return bool(abs(value - expected) <= mpf(10) ** -digits * abs(expected))


def hertz_load() -> mpf:
    """pi E* h**2/(16 R)."""
    with mpmath.workdps(60):
        return mpmath.pi * mpf("1.25") * mpf("2.75") ** 2 / (16 * mpf("1.5"))


# ------------------------------------------------------------------ quadrature


def test_what_grows_at_an_end_and_what_is_singular_just_beyond_it() -> None:
    """int_0^1 dy/sqrt(y) = 2; int_0^1 dy/(sqrt(y) (y + d)) = 2 atan(1/sqrt(d))/sqrt(d)."""
    for beyond in ("1e-3", "1e-40"):
        d = mpf(beyond)
        root, pole = integrals(
            lambda y, _, __, d=d: [1 / y.sqrt(), 1 / (y.sqrt() * (y + ball(d)))],
            [mpf(0), mpf(1)],
            30,
            near=float(d),
        )
        with mpmath.workdps(40):
            assert close(root, mpf(2))
            assert close(pole, 2 * mpmath.atan(1 / mpmath.sqrt(d)) / mpmath.sqrt(d))


def test_nothing_without_a_value_is_passed_over() -> None:
    with pytest.raises(ArithmeticError, match="no value"):
        integrals(lambda y, _, __: [(y - 1 / ball(mpf(2))).log()], [mpf(0), mpf(1)], 20)


# ------------------------------------------------------------------ definitions

INTEGRATED = {
    "power": {"k": 1.25, "L": 0.75},
    "hyperbola": {"phi": 0.125, "b": 0.25},
    "circular_arc": {"R": 4.0},
    "catenary": {"R": 1.5, "b": 0.5},
}


@pytest.mark.enough("1.5-1.25-*")
@pytest.mark.parametrize("body", INTEGRATED)
@pytest.mark.parametrize(("a", "c"), [(1.5, 1.25), (0.25, 2.0), (-0.125, 1.5)])
def test_definitions_are_the_sheets_formulas(body: str, a: float, c: float) -> None:
    """Its integrals, by the rule of the proofs."""
    given = {"a": a, "c": c, "x": 0.5, "E_star": 1.25, **INTEGRATED[body]}
    with mpmath.workdps(36):
        known = {name: mpf(value) for name, value in given.items()}
        for name in ("tilt", "load", "moment", "K_N_left", "L_N_right", "pressure"):
            expr = sheet_of(body).flat(name)
            expected = numeric(expr)({s: known[str(s)] for s in expr.free_symbols})
            assert close(formula(body, name)(**known), expected, 20), name


# ------------------------------------------------------------------ tractions


def test_shear_of_a_cylinder_is_cattaneos_and_mindlins() -> None:
    """q = f p - f p of the patch of half-width b sqrt(1 - Q/(f P)); after a fall by dQ, with
    Mindlin's patch sqrt(1 - dQ/(2 f P)): q = -f p - f p_1 + 2 f p_2."""
    given = {**HERTZ, "a": 1.375, "c": 1.375, "sigma": 0.0, "dsigma": 0.0}
    P, half = hertz_load(), mpf("1.375")
    given |= {"Q": 0.25, "dQ": 0.125, "x": 0.5}
    with mpmath.workdps(50):
        halves = [half * mpmath.sqrt(1 - v / P) for v in (mpf("0.5"), mpf("0.125"))]

        def p(b: mpf) -> mpf:
            return mpf("1.25") / (2 * mpf("1.5")) * mpmath.sqrt(b**2 - mpf("0.25"))

        start = [float(b) for b in halves for _ in "ac"]
        (q,) = partial_slip.shear("hertz").answer(start, given).numbers
        assert close(q, (-p(half) - p(halves[0]) + 2 * p(halves[1])) / 2)
