"""Reading g(x): one slope for every way to write a body, and a reason for every refusal."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    Abs,
    And,
    Eq,
    EulerGamma,
    Expr,
    Heaviside,
    Integer,
    Max,
    Min,
    Not,
    Piecewise,
    Rational,
    Symbol,
    Xor,
    cosh,
    expand,
    floor,
    log,
    oo,
    sign,
    simplify,
    sqrt,
    zeta,
)

from derive import Geometry, parameter, x
from derive.body.profile import Slope, read_slope
from derive.codegen.cuts import cuts_of
from derive.command.errors import BadProfile
from tests.derive.bodies import R1, R, b, k, phi, psi

b2 = parameter("b2", "another width", unit="m")
gap = parameter("gap", "by how much further", unit="m")

beyond = Abs(x) - b


def slope(g: Expr, name: str = "body") -> Slope:
    return Geometry(name, g=g).slope


_b, _R, _R1, _phi = (Symbol(name, positive=True) for name in ("b", "R", "R1", "phi"))
FLAT_ROUNDED = Max(0, beyond) ** 2 / (2 * R)
WAYS = [
    # g' = -phi for x < 0, +phi for x > 0: a jump of 2 phi at the apex
    *(
        (g, -_phi, [(0, 1, 2 * _phi)])
        for g in (
            *(phi * Abs(x), phi * Max(x, -x), -phi * Min(x, -x), phi * x * sign(x)),
            *(phi * x * (2 * Heaviside(x) - 1), Piecewise((-phi * x, x < 0), (phi * x, True))),
            *(Piecewise((0, Eq(x, 0)), (phi * Abs(x), True)), phi * Abs(Abs(x))),
            phi * Abs(x - b) / sqrt(1 - 2 * b / x + b**2 / x**2),
        )
    ),
    # g' = 0 within, (x - b)/R to the right, (x + b)/R to the left
    *(
        (g, 0, [(-_b, -1, expand((x + _b) / _R)), (_b, 1, expand((x - _b) / _R))])
        for g in (
            *(FLAT_ROUNDED, Piecewise((0, beyond <= 0), (beyond**2 / (2 * R), True))),
            (Max(0, x - b) ** 2 + Max(0, -x - b) ** 2) / (2 * R),
            Piecewise((0, And(x > -b, x < b)), (beyond**2 / (2 * R), True)),
            Piecewise((beyond**2 / (2 * R), Not(And(x > -b, x < b))), (0, True)),
        )
    ),
    # g' = x/R1 to the left, x/R to the right
    *(
        (g, x / _R1, [(0, 1, x / _R - x / _R1)])
        for g in (
            Piecewise((x**2 / (2 * R1), x < 0), (x**2 / (2 * R), True)),
            Max(0, x) ** 2 / (2 * R) + Min(0, x) ** 2 / (2 * R1),
            x**2 * ((1 + sign(x)) / R + (1 - sign(x)) / R1) / 4,
        )
    ),
    # phi (b - |x| + |x|) within, phi (2|x| - b) beyond
    *(
        (g, 0, [(-_b, -1, -2 * _phi), (_b, 1, 2 * _phi)])
        for g in (phi * (Abs(beyond) + Abs(x)), phi * Max(b, 2 * x - b, -2 * x - b))
    ),
    # a branch that changes nothing makes no kink
    *(
        (g, 2 * x / _R, [])
        for g in (
            *(Abs(x**2) / R, Max(x**2, -(x**2)) / R),
            Piecewise((x**2 / R, x < b), (x**2 / R, True)),
        )
    ),
]
"""Profiles by what their slopes consist of, in plain symbols."""


@pytest.mark.parametrize(("g", "base", "kinks"), WAYS, ids=str)
def test_every_way_to_write_a_body_has_one_slope(g: Expr, base: Expr, kinks: list) -> None:
    found = slope(g)
    assert found.base == base
    assert [(k.position, k.side, k.jump) for k in found.kinks] == kinks


@pytest.mark.parametrize(
    ("g", "places", "sides"),
    [
        (phi * (Abs(x - b) + Abs(x - 2 * b) + Abs(x + 3 * b)), ["-3*b", "b", "2*b"], [-1, 1, 1]),
        (Max(0, x**2 - R * R1) / R, ["-sqrt(R)*sqrt(R1)", "sqrt(R)*sqrt(R1)"], [-1, 1]),
        # the root of a square is a modulus
        (sqrt(x**2 - 2 * x * b + b**2) * phi + 4 * x**2 / b, ["b"], [1]),
        (sqrt(x**2 - 2 * sqrt(3) * x * b + 3 * b**2) * phi + 4 * x**2 / b, ["sqrt(3)*b"], [1]),
        # (b - sqrt(b^2 + b2^2)) (b + sqrt(b^2 + b2^2)) = -b2^2 tells the sign of the first
        (
            phi * Abs(x) + Max(0, x**2 - 2 * b * x - b2**2) / R,
            *(["b - sqrt(b**2 + b2**2)", "0", "b + sqrt(b**2 + b2**2)"], [-1, 1, 1]),
        ),
        # where the origin lies may be open: b - b2 may be of either sign
        (phi * Max(Abs(x - b) - b2, 0) + x**2 / R, ["b - b2", "b + b2"], [-1, 1]),
        # what the refusal of an open order proposes: b2 = b + gap
        (phi * Abs(x - b) + psi * Abs(x - b - gap), ["b", "b + gap"], [1, 1]),
        # x**3 > b**3 for x > b, whatever b is: b is not compared with one metre, as at x = b - 1
        (Max(0, x**3 - b**3) / b2**2 + x**2 / R, ["b"], [1]),
        (Max(0, x**3 - b2 * b**2) / R**2 + x**2 / R, ["b**(2/3)*b2**(1/3)"], [1]),
        (Max(0, (x - b) * (x**2 + b2**2)) / b2**2 + x**2 / R, ["b"], [1]),
        (
            Max(0, x**3 - b**3, 2 * x**3 - 16 * b**3) / R**2 + x**2 / R,
            *(["b", "15**(1/3)*b"], [1, 1]),
        ),
        (Piecewise(((x**3 - b**3) / R**2, x**3 >= b**3), (0, True)) + x**2 / R, ["b"], [1]),
    ],
    ids=str,
)
def test_kinks_are_found_from_left_to_right(g: Expr, places: list[str], sides: list[int]) -> None:
    kinks = slope(g).kinks
    assert [str(k.position) for k in kinks] == places
    assert [k.side for k in kinks] == sides
    assert [k.number for k in kinks] == list(range(1, len(kinks) + 1))


_coefficient = st.fractions(min_value=Fraction(1, 8), max_value=4, max_denominator=8)


@pytest.mark.slow
@settings(max_examples=5)
@given(
    st.lists(
        st.tuples(_coefficient, st.integers(-3, 3), st.integers(1, 3)), min_size=1, max_size=3
    ),
    st.fractions(min_value=-2, max_value=2, max_denominator=4),
)
def test_any_sum_of_convex_ramps_is_read_right(
    ramps: list[tuple[Fraction, int, int]], incline: Fraction
) -> None:
    """g = t x + sum k max(0, x - j b)^n b^(1-n) has g' = t + sum k n ((x - j b)/b)^(n-1)."""
    g = Rational(incline) * x + sum(
        Rational(k) * Max(0, x - j * b) ** n / b ** (n - 1) for k, j, n in ramps
    )
    found = slope(g)
    width = Symbol("b", positive=True)
    for place in [Fraction(i, 2) for i in range(-9, 10, 2)]:
        expected = incline + sum(k * n * (place - j) ** (n - 1) for k, j, n in ramps if place > j)
        total = found.base.subs(x, Rational(place) * width)
        for kink in found.kinks:
            if kink.side * (Rational(place) - kink.position / width) > 0:
                total += kink.jump.subs(x, Rational(place) * width)
        assert simplify(total - Rational(expected)) == 0


@pytest.mark.parametrize(
    ("g", "domain", "limits", "cuts"),
    [
        (R * cosh(x / R), (-oo, oo), (-oo, oo), (0,)),
        (sqrt(x**2 + R**2), (-oo, oo), (-1, 1), (0,)),
        (R - sqrt(R**2 - x**2), (-R, R), (-oo, oo), (0,)),
        (Abs(x) ** Rational(3, 2) / sqrt(R), (-oo, oo), (-oo, oo), (0,)),
    ],
    ids=str,
)
def test_what_is_no_polynomial_on_its_pieces_is_read_all_the_same(
    g: Expr, domain: tuple[Expr, Expr], limits: tuple[Expr, Expr], cuts: tuple[Expr, ...]
) -> None:
    """Where it is real, its slopes at the ends, and where quadrature must cut it."""
    found = slope(g)
    assert not found.is_polynomial
    assert str(found.domain) == str(domain)
    assert str(found.limits) == str(limits)
    assert str(cuts_of(found)[0]) == str(cuts)
    assert found.demands == ()


def test_an_exponent_must_lie_above_one() -> None:
    """Abs(x)**k is convex for k > 1; its slope at the apex, 0**(k - 1), is then no corner."""
    found = slope(R * (Abs(x) / R) ** k)
    assert str(found.demands) == "(k > 1,)"
    assert found.kinks[0].step == 0
    assert found.limits == (-oo, oo)
    beside = slope(b * (Abs(x) / b) ** k + phi * sqrt(x**2 + b**2))  # outgrown by |x|**(k - 2)
    assert [str(demand) for demand in beside.demands] == ["k > 1"]


def test_a_corner_whose_sign_hangs_on_a_parameter() -> None:
    """x**2/(2 R) + (phi - 1/200) |x| is convex for phi > 1/200 alone."""
    found = slope(x**2 / (2 * R) + Abs(x) * (phi - Rational(1, 200)))
    assert str(found.demands) == "(phi > 1/200,)"


def test_two_parabolas_need_to_be_told_which_is_wider() -> None:
    """(x/(x - b))^2 = R1/R has two real roots unless R1 = R; x/(x - b) = sqrt(R1/R) > 0 lies beyond
    b where R1 > R, on the other side of the origin where R1 < R: `the sign of R - R1` is refused.
    """
    found = slope(Max(x**2 / R1, (x - b) ** 2 / (R1 + gap))).kinks
    values = {"R1": 1.0, "gap": 3.0, "b": 1.0}  # x = (1 - x)/2 or x = (x - 1)/2: -1 and 1/3
    places = [k.position.subs({s: values[str(s)] for s in k.position.free_symbols}) for k in found]
    assert [float(place) for place in places] == pytest.approx([-1, 1 / 3], rel=1e-14)


def test_a_switch_beside_another_is_not_taken_for_it() -> None:
    """x**2/(2 R) < -1e-30 x between -2e-30 R and 0; of a binary 1e-30 SymPy finds 0 alone."""
    radius = Symbol("R", positive=True)
    with pytest.raises(BadProfile):
        read_slope("body", Max(x**2 / (2 * radius), -1e-30 * x))
    for small in (1e-30, 1 / Integer(10) ** 30):  # a Geometry takes a decimal number as a fraction
        assert len(slope(Max(x**2 / (2 * R), -small * x)).kinks) == 2


REFUSED = {
    "is not convex; make g(x) convex": [
        *(-(x**2) / R, x**3 / R**2, -phi * Abs(x), Abs(x**2 - b**2) / R),
        Piecewise((x**2 / R, x < b), (b**2 / R, True)),
    ],
    "jumps by b at x = 0; shift one piece": [Piecewise((x**2 / R, x < 0), (x**2 / R + b, True))],
    "jumps by -b*phi at x = -b; shift one piece": [
        Piecewise((phi * b, Abs(x) < b), (2 * phi * Abs(x), True))
    ],
    "is straight; convex somewhere": [phi * x + b, phi * (Max(0, x) - Max(0, -x))],
    "is constant, because it does not contain x; write g as a function of x": [Abs(b), 0],
    # Each of these has a curvature that is real, and positive where it is, around the place.
    "is not real near x = -; real and finite on both sides of x = 0": [
        *(b * (x / b) ** Rational(4, 3), x**2 / R - b * log((x - b) / b))
    ],
    "is not real near x = ; shift it along x": [phi * sqrt((x - b) ** 3 / b) + x**2 / R],
    "is infinite at x = 0; shift it along x": [
        *(-b * log(x / b), -b * log(Abs(x) / b), b**2 / Abs(x), b ** (k + 1) * Abs(x) ** -k)
    ],
    "is infinite at x = b; shift it along x": [
        b**3 / (x - b) ** 2 + phi * Abs(x) + phi * Max(0, x - 2 * b)
    ],
    "contains EulerGamma, which the proofs cannot compute; replace it with a parameter": [
        EulerGamma * phi * sqrt(x**2 + b**2)
    ],
    "has no value at x = 0; shift it along x": [b * (Abs(x) / b) ** k * log(Abs(x) / b) + x**2 / R],
    "a function of x that is not supported; cosh": [*(floor(x / R) * R, R * zeta(2 + x**2 / R**2))],
    "not a polynomial in x; polynomials": [
        *(Max(0, R * cosh(x / R) - 2 * x**2 / R), Abs(R * cosh(x / R) - R))
    ],
    "is not defined near; (expression, True)": [
        *(Piecewise((x**2 / R, x < 0)), Piecewise((x**2 / R, Abs(x) > b)))
    ],
    "in an unknown order; b2 = b + gap": [(Max(0, x - b) ** 2 + Max(0, x - b2) ** 2) / R],
    "in an unknown order; psi = phi + gap": [Max(0, phi * x, psi * x) + x**2 / R],
    "the sign of R - R1 depends on the parameters; R1 = R + gap": [
        Max(x**2 / R1, (x - b) ** 2 / R)
    ],
    # Where both parabolas meet depends on which is wider; the smaller must not win silently.
    "for some parameters; ": [
        *(Max(x**2 / (2 * R), x**2 / (2 * R1) - b), Max(0, x**2 - (R - R1) * b) / b)
    ],
    # A point sticks out between two pieces, which meet as if it were not there.
    "has the value ; continuous": [
        *(Piecewise((-b, Eq(x, 0)), (x**2 / R, True)), x**2 / R + b * sign(x) ** 2),
        Piecewise((0, x < 0), (b, Eq(x, b) | Eq(x, 2 * b)), (x**2 / R, True)),
    ],
    # x^5 - b^4 x - b^5 changes its sign near x = 1.17 b, and has no root in radicals.
    "; ": [
        Piecewise((x**2 / (2 * R), x**5 - b**4 * x - b**5 < 0), (x**2 / R, True)),
        x**2 / R + Max(0, x**5 - b**4 * x - b**5) / b**4,
    ],
    "not supported; use <, <=, > or >=": [
        Piecewise((beyond**2 / R, Xor(x > -b, x < b)), (0, True))
    ],
}
"""Bodies by why they are refused, and what the remedy says."""


@pytest.mark.parametrize(
    ("words", "g"), [(words, g) for words, bodies in REFUSED.items() for g in bodies], ids=str
)
def test_a_body_that_will_not_do_is_refused_with_the_reason(words: str, g: Expr) -> None:
    why, remedy = words.split("; ")
    with pytest.raises(BadProfile) as caught:
        slope(g)
    assert why in caught.value.why
    assert remedy in caught.value.remedy
