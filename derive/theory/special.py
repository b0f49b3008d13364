r"""Terms of g' whose integrals over the contact are special functions: one rule for each kind.

With s = mid + (h/2) X and X = cos(theta), all loads and coefficients of a contact are integrals of
g' and its derivatives over 0 < theta < pi, weighted by polynomials W(X):

    alpha = -(1/pi) int g',     P = (E*/4) h int X g',
    M = -(E*/16) h int (h (2 X**2 - 1) + 4 mid X) g',
    K_right = E* sqrt(h)/(2 pi) int (1 + X) g'',
    L_right = -E*/(pi sqrt(h)) int [ (1 + X) g''/4 + h (1 + X)**2 g'''/6 ],

K_left with 1 - X, and L_left with (1 - X) g''/4 - h (1 - X)**2 g'''/6.  K_N is the rate of the tilt
as an edge moves, and L_N the rate of K_N, because a moving edge adds a flat punch to the pressure.

Evaluated in float64 with SciPy's functions, these forms lose digits.  E - (1 - m) K loses all of
them if m is small.  2F1 loses up to nine if a kink lies close to an edge, because its argument is
then rounded next to one.  The Bessel functions lose three where two of them nearly cancel.

Each rule states the integrals on which it is based.  Elliptic integrals follow SymPy: they take the
parameter m, not the modulus, and Pi(n|m) has 1 - n sin**2 in its denominator.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

from sympy import (
    Expr,
    Function,
    Integer,
    Piecewise,
    Poly,
    Rational,
    S,
    Symbol,
    besseli,
    chebyshevt,
    cosh,
    diff,
    elliptic_e,
    elliptic_k,
    elliptic_pi,
    exp,
    factor,
    factorial,
    ff,
    gamma,
    hyper,
    pi,
    sinh,
    sqrt,
)
from sympy.polys.fields import sfield
from sympy.polys.rings import PolyElement, PolyRing

from derive.symbols import E_star, a, c, h, mid, x
from derive.theory.frame import RootFrame

X = Symbol("X")
"""cos(theta): -1 at the left edge, 1 at the right edge."""

_HALF = Rational(1, 2)

Weights = Mapping[int, Expr]
"""W(X) by the order of the derivative of g' to which the weight belongs."""

WEIGHTS: Mapping[str, tuple[Expr, Weights]] = {
    "tilt": (-1 / pi, {0: S.One}),
    "load": (E_star / 4, {0: h * X}),
    "moment": (-E_star * h / 16, {0: h * (2 * X**2 - 1) + 4 * mid * X}),
    "K_N_left": (E_star * sqrt(h) / (2 * pi), {1: 1 - X}),
    "K_N_right": (E_star * sqrt(h) / (2 * pi), {1: 1 + X}),
    "L_N_left": (-E_star / (pi * sqrt(h)), {1: (1 - X) / 4, 2: -h * (1 - X) ** 2 / 6}),
    "L_N_right": (-E_star / (pi * sqrt(h)), {1: (1 + X) / 4, 2: h * (1 + X) ** 2 / 6}),
}
"""Factor and weights of each formula."""


Integrals = dict[Expr, Expr]
"""A sum of special functions, each with its coefficient."""


class Special(Protocol):
    """A kind of term, without its polynomial factor."""

    @property
    def term(self) -> Expr:
        """The term as a function of x."""
        ...

    def weighted(self, polynomial: Expr, weights: Weights) -> Integrals:
        """Integrals over theta of W(X) times derivatives of polynomial(x) times the term."""
        ...


def _along(polynomial: Expr) -> Expr:
    """A polynomial in x, written as one in X."""
    return polynomial.subs(x, mid + h / 2 * X)


# ------------------------------------------------------------------ powers on a half line


@dataclass(frozen=True)
class Power:
    r"""t**p with t = side (x - place) > 0; zero where t < 0.

    Let u be the distance from the place to the edge on its side.  If u < h,

        int t**p cos(n theta)   = sqrt(pi) Gamma(p+1)/Gamma(p+3/2) u**(p+1/2)/sqrt(h)
                                  2F1(1/2-n, 1/2+n; p+3/2; u/h),
        int (d/dt)**j t**p cos(theta/2)**(2j)
                                = sqrt(pi) Gamma(p+1)/Gamma(p-j+3/2) u**(p-j+1/2)/sqrt(h)
                                  2F1(1/2-j, 1/2; p-j+3/2; u/h),
        int (d/dt)**j t**p sin(theta/2)**(2j)
                                = Gamma(j+1/2) Gamma(p+1)/Gamma(p+3/2) u**(p+1/2)/h**(j+1/2)
                                  2F1(1/2, 1/2+j; p+3/2; u/h);

    If the place lies beyond the other edge, u > h, then with p(p-1)... having n or j factors,

        int t**p cos(n theta)   = pi p(p-1).../n! u**p (h/(4u))**n 2F1(n-p, n+1/2; 2n+1; h/u),
        the second and third    = p(p-1)... u**(p-j) B(1/2, j+1/2) 2F1(j-p, 1/2; j+1; h/u),
                                  the same with 2F1(j-p, 1/2+j; j+1; h/u).

    For the other side, theta is replaced by pi - theta.

    outside: the body ends at the place, which then lies beyond the other edge of every contact.  In
    this case p may be negative.
    """

    place: Expr
    side: int
    exponent: Expr
    outside: bool = False

    @property
    def term(self) -> Expr:
        """As a function of x."""
        return (self.side * (x - self.place)) ** self.exponent

    def weighted(self, polynomial: Expr, weights: Weights) -> Integrals:
        """Write the polynomial factor in t, so that it only raises the exponent."""
        t = Symbol("t")
        inner = Poly(polynomial.subs(x, self.place + self.side * t), t)
        found: Integrals = {}
        for (power,), coefficient in inner.terms():
            raised = replace(self, exponent=self.exponent + power)
            for value, k in raised._weighted(weights):
                found[value] = found.get(value, S.Zero) + coefficient * k
        return found

    def _weighted(self, weights: Weights) -> Iterator[tuple[Expr, Expr]]:
        """Integrals by cos(n theta); those of derivatives by their weights (1 +/- X)**j."""
        for order, weight in weights.items():
            mirrored = weight.subs(X, self.side * X)
            if order == 0:
                yield from ((self._cosine(n), k) for n, k in _in_cosines(mirrored).items())
                continue
            sense = Integer(self.side) ** order
            near, far = (sense * mirrored.subs(X, end) for end in (1, -1))
            if near != 0:
                yield self._near(order), near
            if far != 0:
                yield self._far(order), far

    @property
    def _u(self) -> Expr:
        return c - self.place if self.side > 0 else a + self.place

    def _branches(self, inside: Expr, beyond: Expr) -> Expr:
        """Cases: the contact ends before the place, spans it, or lies beyond it."""
        if self.outside:
            return beyond
        before, spans = c <= self.place, a > -self.place
        if self.side < 0:
            before, spans = a <= -self.place, c > self.place
        return Piecewise((S.Zero, before), (inside, spans), (beyond, True))

    def _cosine(self, n: int) -> Expr:
        """int t**p cos(n theta), with theta from the edge on the side of the term."""
        p, u = self.exponent, self._u
        scale = sqrt(pi) * gamma(p + 1) / gamma(p + 3 * _HALF)
        inside = (
            scale * u ** (p + _HALF) / sqrt(h) * _gauss(_HALF - n, _HALF + n, p + 3 * _HALF, u / h)
        )
        rate = pi * ff(p, n) / factorial(n)
        beyond = rate * u**p * (h / (4 * u)) ** n * _gauss(n - p, n + _HALF, 2 * n + 1, h / u)
        return self._branches(inside, beyond)

    def _near(self, j: int) -> Expr:
        """int (d/dt)**j t**p cos(theta/2)**(2j)."""
        p, u = self.exponent, self._u
        last = p - j + 3 * _HALF
        scale = sqrt(pi) * gamma(p + 1) * u ** (last - 1) / sqrt(h)
        if last == 0:  # 2F1(first, second; last; z)/Gamma(last) in the limit
            function = (_HALF - j) * _HALF * u / h * _gauss(3 * _HALF - j, 3 * _HALF, 2, u / h)
        else:
            function = _gauss(_HALF - j, _HALF, last, u / h) / gamma(last)
        return self._branches(
            scale * function, self._beyond(j) * _gauss(j - p, _HALF, j + 1, h / u)
        )

    def _far(self, j: int) -> Expr:
        """int (d/dt)**j t**p sin(theta/2)**(2j)."""
        p, u = self.exponent, self._u
        last = p + 3 * _HALF
        scale = gamma(j + _HALF) * gamma(p + 1) / gamma(last)
        inside = scale * u ** (last - 1) / h ** (j + _HALF) * _gauss(_HALF, _HALF + j, last, u / h)
        return self._branches(inside, self._beyond(j) * _gauss(j - p, _HALF + j, j + 1, h / u))

    def _beyond(self, j: int) -> Expr:
        p, u = self.exponent, self._u
        beta = sqrt(pi) * gamma(j + _HALF) / factorial(j)
        return ff(p, j) * u ** (p - j) * beta


def _gauss(first: Expr, second: Expr, third: Expr, at: Expr) -> Expr:
    """The hypergeometric function 2F1."""
    return hyper((first, second), (third,), at)


def _in_cosines(weight: Expr) -> dict[int, Expr]:
    """A polynomial in X as a sum of cos(n theta): the coefficient for each n."""
    found: dict[int, Expr] = {}
    rest = Poly(weight, X)
    while not rest.is_zero:
        n = rest.degree()
        top = Poly(chebyshevt(n, X), X)
        found[n] = rest.LC() / top.LC()
        rest = Poly(rest.as_expr() - found[n] * top.as_expr(), X)
    return found


# ------------------------------------------------------------------ exponentials


@dataclass(frozen=True)
class Exponential:
    r"""exp, sinh or cosh of beta x + delta.

    Since int exp(z cos(theta)) cos(n theta) = pi I_n(z), with z = beta h/2,

        int exp(beta s + delta) cos(n theta)  = pi exp(beta mid + delta) I_n(z),
        int sinh(beta s + delta) cos(n theta) = pi sinh(beta mid + delta) I_n(z) for even n,
                                                pi cosh(beta mid + delta) I_n(z) for odd n,

    and likewise for cosh.
    """

    kind: type[Function]
    argument: Expr

    @property
    def term(self) -> Expr:
        """As a function of x."""
        return self.kind(self.argument)

    other: ClassVar[Mapping[type[Function], type[Function]]] = {exp: exp, sinh: cosh, cosh: sinh}

    def weighted(self, polynomial: Expr, weights: Weights) -> Integrals:
        """Treat the polynomial factor as a part of the weight."""
        found: Integrals = {}
        for order, weight in weights.items():
            for kind, times in self._derivative(polynomial, order).items():
                for n, k in _in_cosines(weight * _along(times)).items():
                    value = self._cosine(kind, n)
                    found[value] = found.get(value, S.Zero) + k
        return found

    @property
    def _beta(self) -> Expr:
        return diff(self.argument, x)

    def _derivative(self, polynomial: Expr, order: int) -> dict[type[Function], Expr]:
        """Derivative of polynomial(x) times the term: the factor of each function."""
        held = {self.kind: polynomial}
        for _ in range(order):
            after: dict[type[Function], Expr] = {}
            for kind, times in held.items():
                for other, more in ((kind, diff(times, x)), (self.other[kind], self._beta * times)):
                    after[other] = after.get(other, S.Zero) + more
            held = after
        return held

    def _cosine(self, kind: type[Function], n: int) -> Expr:
        kind = self.other[kind] if n % 2 else kind
        return (
            pi * kind(factor(self.argument.subs(x, mid))) * besseli(n, factor(self._beta * h / 2))
        )


# ------------------------------------------------------------------ square roots of quadratics


@dataclass(frozen=True)
class Root:
    r"""q**(-1/2 - level), with q = q_2 x**2 + q_1 x + q_0 positive throughout the contact.

    The substitution cos(theta) = -(nu + mu)/(1 + mu nu), nu = cn(v), maps the edges to v = 0 and
    v = 2 K.  With A = sqrt(q(c)), B = sqrt(q(-a)) and mu = (A - B)/(A + B),

        m = (q_2 h**2 - (A - B)**2)/(4 A B),    n = q_2 h**2/(A + B)**2.

    Both are real and below one for any sign of q_2 or of the discriminant of q.

        U_0 = int 1/sqrt(q)   = 2 K(m)/sqrt(A B),
        U_1 = int X/sqrt(q)   = -(A**2 - B**2)/(q_2 h**2) 2/sqrt(A B) (K(m) - (1 - n) Pi(n|m)),
        q_2 h**2/4 U_2        = 2 sqrt(A B) (E(m) - (1 - m) K(m)) - (A**2 - B**2)/4 U_1.

    In terms of X, q = q0 + q1 X + q2 X**2.  The other integrals follow from these three, because
    those of the derivatives of sin(theta) X**k q**(1/2 - level) vanish.
    """

    frame: RootFrame
    level: int = 0

    @property
    def term(self) -> Expr:
        """As a function of x."""
        return self.frame.quadratic ** (-_HALF - self.level)

    def weighted(self, polynomial: Expr, weights: Weights) -> Integrals:
        """Treat the polynomial factor as a part of the weight."""
        numerators = [
            (self.level + order, weight * _along(self._derivative(polynomial, order)))
            for order, weight in weights.items()
        ]
        polynomials = [_along(self.frame.quadratic), *(whole for _, whole in numerators)]
        rows = [Poly(whole, X).all_coeffs() for whole in polynomials]
        field, elements = sfield([k for row in rows for k in row])
        inside, polynomials_in = iter(elements), PolyRing(X, field)
        q, *others = (polynomials_in.from_list([next(inside) for _ in row]) for row in rows)
        left = sum(
            (
                _reduced(other, level, q)
                for (level, _), other in zip(numerators, others, strict=True)
            ),
            polynomials_in.zero,
        )
        (_, q1, q2), (U_0, U_1, U_2) = (
            [p.coeff(q.ring.gens[0] ** k) for k in range(3)] for p in (q, left)
        )
        ratio = q1 / q2
        third = (U_1 - U_2 * ratio / 2) * ratio
        return self._written([k.as_expr() for k in (2 * U_0 - third, 2 * U_2 / q2, third)])

    def _derivative(self, polynomial: Expr, order: int) -> Expr:
        """Numerator of the derivative of polynomial(x) times the term."""
        q = self.frame.quadratic
        for level in range(self.level, self.level + order):
            polynomial = diff(polynomial, x) * q - (level + _HALF) * polynomial * diff(q, x)
        return polynomial

    def _written(self, coefficients: list[Expr]) -> Integrals:
        """The sum by K, E - (1 - m) K and (1 - n) Pi."""
        f = self.frame
        mean, K = sqrt(f.left * f.right), elliptic_k(f.m)
        third_kind = (1 - f.n) * elliptic_pi(f.n, f.m)
        first, second, third = (factor(k) for k in coefficients)
        second_kind = elliptic_e(f.m) - (1 - f.m) * K
        return {second_kind * mean: second, K / mean: first, third_kind / mean: third}


def _reduced(numerator: PolyElement, level: int, q: PolyElement) -> PolyElement:
    """The polynomial of degree two with int polynomial/sqrt(q) = int numerator q**(-1/2 - level).

    Derivatives, whose integrals vanish, are subtracted, first until q divides the numerator.
    """
    X = q.ring.gens[0]
    if level:
        first, second = (_vanishing(r, level, q) for r in (X**0, X))
        rests = [polynomial.rem(q) for polynomial in (first, second, numerator)]
        (p, r, wanted), (s, t, wanted_of_X) = ([rest.coeff(X**k) for rest in rests] for k in (0, 1))
        determinant = p * t - r * s
        numerator -= first * ((wanted * t - wanted_of_X * r) / determinant)
        numerator -= second * ((wanted_of_X * p - wanted * s) / determinant)
        return _reduced(numerator.quo(q), level - 1, q)
    while numerator.degree() > 2:
        highest = _vanishing(X ** (numerator.degree() - 3), level, q)
        numerator -= highest * (numerator.LC / highest.LC)
    return numerator


def _vanishing(r: PolyElement, level: int, q: PolyElement) -> PolyElement:
    """Numerator over q**(1/2 + level) of the derivative of sin(theta) r(X) q**(1/2 - level)."""
    X = q.ring.gens[0]
    square = 1 - X**2
    own = (X * r - square * r.diff(X)) * q
    return own + square * r * q.diff(X) * (2 * level - 1) / 2
