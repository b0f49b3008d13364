"""For which parameters a body is convex: conditions by hand, and against the least curvature."""

import random
from collections.abc import Callable

import pytest
from sympy import (
    Abs,
    E,
    Expr,
    Heaviside,
    Integer,
    Max,
    Piecewise,
    Poly,
    Rational,
    Symbol,
    atan,
    cosh,
    exp,
    log,
    pi,
    sqrt,
    tanh,
)

from derive import Geometry, parameter, x
from derive.command.errors import BadProfile
from derive.command.limit import within
from derive.proof.points import contacts, holds
from derive.proof.verdict import POINTS
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import load_conditions, tilt_conditions
from tests.derive.bodies import R1, L, R, b, phi, psi

pytestmark = pytest.mark.slow

B = parameter("B", "another length", unit="m")


def demands(g: Expr) -> list[str]:
    return [str(demand) for demand in Geometry("body", g=g).slope.demands]


@pytest.mark.parametrize(
    ("g", "wanted"),
    [
        # g'' = 12 x^2/L^3 - 6 x/(10 L^2) + 2/R; 0.36/L^4 <= 4 * 12 * 2/(L^3 R), R <= 96 L/0.36
        (x**4 / L**3 - x**3 / (10 * L**2) + x**2 / R, ["L >= 3*R/800"]),
        # g'' = 30 x^4/L^5 - 12 x^2/B^3 + 2/R; 144/B^6 <= 4 * 30 * 2/(L^5 R)
        (x**6 / L**5 - x**4 / B**3 + x**2 / R, ["5*B**6 - 3*L**5*R >= 0"]),
        # g'' = 20 x^3/L^4 - 12 x^2/B^3 + 2/R on the right, least at x = 2 L^4/(5 B^3):
        # (4/25)(20 * 2/5 - 12) L^8/B^9 + 2/R >= 0, so that 25 B^9 >= 8 L^8 R
        (
            Max(0, x) ** 5 / L**4 - Max(0, x) ** 4 / B**3 + x**2 / R,
            ["25*B**9 - 8*L**8*R >= 0"],
        ),
        # g'' = 20 x^3/L^4 - 6 x/B^2 + 2/R, least at x = L^2/(sqrt(10) B): (2/3) 6 x/B^2 <= 2/R
        (
            Max(0, x) ** 5 / L**4 - Max(0, x) ** 3 / B**2 + x**2 / R,
            ["5*B**6 - 2*L**4*R**2 >= 0"],
        ),
        # g'' = (x + L)(x^2 - phi b x + b^2)/(b^2 L R) on the right, where x + L > 0
        (
            Piecewise(
                (x**2 / (2 * R), x < 0),
                (
                    ((x + L) * (x**2 - phi * b * x + b**2) / (b**2 * L * R))
                    .integrate(x)
                    .integrate(x),
                    True,
                ),
            ),
            ["2 - phi >= 0"],
        ),
        # With u = x/L > 0, g'' = (u^3 - 7.5 u^2 + 12 u)/L + 1/R, least at u = 4: -8/L + 1/R
        (
            Max(0, x) ** 5 / (20 * L**4)
            - 5 * Max(0, x) ** 4 / (8 * L**3)
            + 2 * Max(0, x) ** 3 / L**2
            + x**2 / (2 * R),
            ["L >= 8*R"],
        ),
        # g'' = 2/R - x^2/L^3 within b, least at b; the slope there rises by
        # phi - 2 b/R + b^3/(3 L^3)
        (
            Piecewise(
                (x**2 / R - x**4 / (12 * L**3), Abs(x) < b),
                (b**2 / R - b**4 / (12 * L**3) + phi * (Abs(x) - b), True),
            ),
            ["2*L**3 - R*b**2 >= 0", "3*L**3*R*phi - 6*L**3*b + R*b**3 > 0"],
        ),
        # g'' = 2/R1 - 2/R everywhere
        (x**2 / R1 - x**2 / R, ["R > R1"]),
        # g'' = 2/R + 6 (1/L^2 - 1/B^2) x + 12 x^2/L^3 on the right: 6 (..) >= -2 sqrt(24/(L^3 R))
        (
            Max(0, x) ** 4 / L**3 + Max(0, x) ** 3 * (1 / L**2 - 1 / B**2) + x**2 / R,
            ["4*sqrt(6)/(L**(3/2)*sqrt(R)) + 6*(B - L)*(B + L)/(B**2*L**2) >= 0"],
        ),
        # g'' = 2/R - 1/(b cosh(x/b)^2), least at the origin
        (x**2 / R - b * log(cosh(x / b)), ["b >= R/2"]),
    ],
    ids=str,
)
def test_what_the_least_curvature_demands(g: Expr, wanted: list[str]) -> None:
    assert demands(g) == wanted


@pytest.mark.enough("(-b + x)*", "phi*", "b*phi*", "pi*", "b*log*", "b*exp(9*")
@pytest.mark.parametrize(
    "g",
    [
        (x - b) ** 6 / R**5 + (x + B) ** 4 / L**3,
        Max(0, x - b) ** 7 / L**6 + Max(0, -x - b - B) ** 5 / R**4 + phi * Abs(x - b / 2),
        phi * b * log(cosh(x / b)),  # 1 - tanh^2 is rounded to less than zero far away
        pi * x**2 / R + E * Max(0, x - b) ** 3 / L**2,  # SymPy isolates no roots beside pi and E
        # exp(99999 x/b) is no power of exp(x/b) to be factored: minutes would pass
        x**2 / b + b * exp(99999 * x / b),
        b * log(exp(99999 * x / b) + 1)
        + Abs(x) ** Rational(12345, 10000) * b ** Rational(-469, 2000),
        phi * Abs(x - b) + b * exp(-((100 * (x / b - 3)) ** 2)) / 50000 + x**2 / b,
    ],
    ids=str,
)
def test_a_body_that_is_always_convex_meets_no_demand(g: Expr) -> None:
    with within(20):
        assert demands(g) == []


SOME, NONE = "convex only for some values of its parameters", "is not convex"


@pytest.mark.parametrize(
    ("g", "why"),
    [
        (x**8 / L**7 + x**4 / B**3 - x**3 / b**2 + x**2 / R, SOME),  # under no condition found
        # falls within or far away
        (phi * sqrt(x**2 + b**2) - psi * sqrt(x**2 + B**2), SOME),
        (E * x**2 / R - pi * Max(0, x - b) ** 3 / L**2, NONE),
        # 56/64 + 3 - 9 + 2 at L/2
        (x**8 / L**7 + x**4 / L**3 - 3 * x**3 / L**2 + x**2 / L, NONE),
    ],
    ids=str,
)
def test_a_body_convex_for_some_parameters_or_none_is_refused_as_such(g: Expr, why: str) -> None:
    with pytest.raises(BadProfile) as caught:
        Geometry("body", g=g)
    assert why in caught.value.why
    assert "numbers" in caught.value.remedy or why is NONE


# Three places a decade miss both: g'' b is least near x = 7 b.
NARROW: dict[str, Callable[[Rational], Expr]] = {
    "atan": lambda size: size * b * atan(30 * (x / b - 7)) / 50,
    "steep tanh": lambda size: size * b * tanh(1000 * (x / b - 7)) / 370370,
}
"""Beside x**2/b, g'' is below zero at a narrow place only for size = 1, nowhere for 1/400."""


@pytest.mark.parametrize("name", NARROW)
def test_a_curvature_that_is_negative_at_a_narrow_place_only_is_found(name: str) -> None:
    with pytest.raises(BadProfile) as caught:
        Geometry("body", g=x**2 / b + NARROW[name](Integer(1)))
    assert "its curvature is negative near x" in caught.value.why
    assert demands(x**2 / b + NARROW[name](Rational(1, 400))) == []


def _least(curvature: Expr, lower: Expr, upper: Expr) -> Expr:
    """The least value of a polynomial at its stationary points and the ends, in numbers."""
    poly, far = Poly(curvature, x), Integer(10**12)
    stationary = [Rational(r) for r in poly.diff(x).nroots(n=40, maxsteps=500) if r.is_real]
    places = [p for p in (*stationary, -far, far) if lower < p < upper]
    return min(poly.eval(p) for p in (*places, *(e for e in (lower, upper) if e.is_finite)))


@pytest.mark.enough("(R*", "x*/B?*2")
@pytest.mark.parametrize(
    "g",
    [
        x**4 / L**3 - x**3 / B**2 + x**2 / R,
        Max(0, x) ** 4 / L**3 + Max(0, x) ** 3 * (1 / R**2 - 1 / B**2) + x**2 / R,
        x**2 / R - Heaviside(b - Abs(x)) * (b**2 - x**2) ** 2 * (b + x) / L**4,
    ],
    ids=str,
)
def test_demands_hold_exactly_where_the_curvature_is_nowhere_negative(g: Expr) -> None:
    body, rng = Geometry("body", g=g), random.Random(7)
    seen = {True: 0, False: 0}
    for _ in range(40):
        values = {
            q.symbol: Rational(2) ** rng.randint(-4, 4) * Rational(rng.randint(9, 15), 12)
            for q in body.parameters
        }
        right = all(
            _least(*(e.subs(values) for e in (piece.curvature, piece.lower, piece.upper))) >= 0
            for piece in body.slope.pieces
        )
        assert all(bool(d.subs(values)) for d in body.slope.demands) == right, values
        seen[right] += 1
    assert min(seen.values()) >= 3


def test_the_sheet_says_what_is_demanded_and_draws_contacts_that_meet_it() -> None:
    """Here L >= 3750 R: 600^2 R <= 96 L."""
    body = Geometry("steep", g=x**4 / L**3 - 100 * x**3 / L**2 + x**2 / R)
    sheet = derive_sheet(body)
    condition = Symbol("L", positive=True) >= 3750 * Symbol("R", positive=True)
    assert condition in load_conditions(sheet.frame)
    assert condition in tilt_conditions(sheet.frame)
    assert "L >= 3750*R" in sheet["load"].assumptions
    drawn = contacts(sheet)
    assert len(drawn) == POINTS
    assert all(holds([condition], point) for point in drawn)
