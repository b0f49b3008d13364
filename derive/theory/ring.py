r"""Expressions as polynomials over the rationals, in FLINT: exact, and much faster than in SymPy.

Everything except a sum, product or power is a generator: a symbol, pi, or a function.  Two more
kinds of generators each come with one relation,

    root      r = base**(1/q),  r**q = base
    inverse   v = 1/base,       v base = 1

so that base**(n + k/q), 0 <= k < q, is base**n r**k.  Any expression is a polynomial in these
generators.
"""

from collections.abc import Iterable, Iterator, Sequence
from math import prod

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx
from sympy import (
    Add,
    Expr,
    Float,
    Mul,
    Pow,
    Rational,
    factorint,
)

Polynomial = fmpq_mpoly


class Ring:
    """The polynomials in the generators of some expressions.

    roots     exponent and base of each root
    inverses  bases that occur in denominators; each follows the ones that it contains
    """

    def __init__(self, exprs: Iterable[Expr]) -> None:
        self.roots: dict[Expr, tuple[int, Expr]] = {}
        self.inverses: list[Expr] = []
        self._atoms: dict[Expr, None] = {}
        self._known: dict[Expr, Polynomial] = {}
        seen: set[Expr] = set()
        for expr in exprs:
            self._gather(expr, seen)
        names = [*self._atoms, *(("inverse", base) for base in self.inverses)]
        self._places = {name: i for i, name in enumerate(names)}
        self._ring = fmpq_mpoly_ctx.get(("x", len(names)), "lex")

    def _gather(self, expr: Expr, seen: set[Expr]) -> None:
        """Find the generators that an expression needs."""
        if expr in seen:
            return
        seen.add(expr)
        if isinstance(expr, Add | Mul):
            for arg in expr.args:
                self._gather(arg, seen)
        elif not isinstance(expr, Rational | Float):
            for base, power in _factors(expr):
                if base == expr:
                    self._atoms[expr] = None
                else:
                    self._gather(base, seen)
                if expr.is_Pow and base == expr and expr.exp.is_Rational:
                    self.roots[expr] = expr.exp.q, expr.base
                if power < 0 and base not in self.inverses:
                    self.inverses.append(base)

    # ------------------------------------------------------------------ to polynomials

    def polynomial(self, expr: Expr) -> Polynomial:
        """The polynomial of an expression whose generators are known."""
        if expr not in self._known:
            self._known[expr] = self._converted(expr)
        return self._known[expr]

    def _converted(self, expr: Expr) -> Polynomial:
        if isinstance(expr, Rational | Float):
            number = Rational(expr)
            return self._ring.constant(fmpq(int(number.p), int(number.q)))
        if isinstance(expr, Add):
            return sum(map(self.polynomial, expr.args), self._ring.constant(0))
        if isinstance(expr, Mul):
            return prod(map(self.polynomial, expr.args), start=self._ring.constant(1))
        if expr in self._atoms:
            return self._ring.gen(self._places[expr])
        powers = (self._power(base, power) for base, power in _factors(expr))
        return prod(powers, start=self._ring.constant(1))

    def _power(self, base: Expr, power: int) -> Polynomial:
        if power >= 0:
            return self.polynomial(base) ** power
        return self._ring.gen(self._places["inverse", base]) ** -power

    # ------------------------------------------------------------------ rewriting polynomials

    def apart(
        self, polynomial: Polynomial, generators: Sequence[object]
    ) -> dict[tuple[int, ...], Polynomial]:
        """Coefficients of the powers of some generators; they contain none of these generators."""
        places = [self._places[g] for g in generators if g in self._places]
        parts: dict[tuple[int, ...], dict[tuple[int, ...], fmpq]] = {}
        for monomial, coefficient in polynomial.to_dict().items():
            left = [*monomial]
            for place in places:
                left[place] = 0
            powers = tuple(monomial[place] for place in places)
            parts.setdefault(powers, {})[tuple(left)] = coefficient
        return {powers: self._ring.from_dict(part) for powers, part in parts.items()}

    def lowered(
        self, polynomial: Polynomial, generator: Expr, exponent: int, value: Expr, least: int = 0
    ) -> Polynomial:
        """Replace generator**exponent by `value` as long as the power stays at least `least`."""
        if generator not in self._places:
            return polynomial
        symbol, total = self.polynomial(generator), self._ring.constant(0)
        for (power,), part in self.apart(polynomial, [generator]).items():
            times = max(power - least, 0) // exponent
            total += part * self.polynomial(value) ** times * symbol ** (power - times * exponent)
        return total

    def cleared(self, polynomial: Polynomial, bases: Iterable[Expr]) -> Polynomial:
        """Multiply by the lowest powers of `bases` that remove all their inverses."""
        for base in sorted(bases, key=self.inverses.index, reverse=True):
            highest = polynomial.degrees()[self._places["inverse", base]]
            if highest > 0:
                parts, by = self.apart(polynomial, [("inverse", base)]), self.polynomial(base)
                lifted = (part * by ** (highest - power) for (power,), part in parts.items())
                polynomial = sum(lifted, self._ring.constant(0))
        return polynomial


def _factors(expr: Expr) -> Iterator[tuple[Expr, int]]:
    """base**(n + k/q) as n times its base and k times its root, base**(n k) as n times base**k.

    The root of an integer is split into roots of primes: sqrt(6) is sqrt(2) sqrt(3), which is not a
    generator of its own.
    """
    base, exponent = expr.as_base_exp()
    if base.is_Integer and base > 1 and not base.is_prime and exponent.is_Rational:
        for prime, times in factorint(base).items():
            yield from _factors(Pow(prime, times * exponent))
        return
    for term in Add.make_args(exponent):
        count, kind = term.as_coeff_Mul(rational=True)
        if kind == 1:
            yield base, int(count.p // count.q)
        if kind != 1 or count.q > 1:
            whole = int(count.p % count.q) if kind == 1 else int(count.p)
            yield base ** (kind / count.q), whole
