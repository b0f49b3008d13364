r"""Tilt, load, moment, K_N and L_N in closed form if g' is a sum of terms that have a rule.

On each piece, g' is written as a sum of polynomials times special terms.  A polynomial may change
at every kink.  An exponential, or the root of a quadratic, must be the same on all pieces.  A power
must extend from its own position to the end of the body.  The integrals of the polynomials are
known, and the rules of `special` provide the others.  If a single term has no rule, all formulas of
the body remain integrals.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import pairwise

from sympy import (
    Add,
    E,
    Expr,
    Poly,
    Rational,
    S,
    cancel,
    cosh,
    exp,
    expand,
    factor,
    simplify,
    sinh,
)

from derive.command.limit import LookAtClock
from derive.symbols import x
from derive.theory.edges import contact_formula
from derive.theory.frame import Frame
from derive.theory.special import WEIGHTS, Exponential, Power, Root, Special


class NoRule(Exception):
    """A term of g', as text, for which there is no rule."""


@dataclass
class Parts:
    """g' on each piece: a polynomial, and the polynomial factor of each special term."""

    polynomials: list[Expr]
    special: dict[Special, list[Expr]] = field(default_factory=dict)

    def add(self, number: int, term: Special | None, polynomial: Expr) -> None:
        """Add a polynomial, or a special term with a polynomial as its factor, to one piece."""
        if term is None:
            self.polynomials[number] += polynomial
            return
        factors = self.special.setdefault(term, [S.Zero] * len(self.polynomials))
        factors[number] += polynomial


def closed_forms(frame: Frame, look: LookAtClock) -> dict[str, Expr]:
    """All formulas for which `special` has weights; `look` is called between the steps.

    Raises NoRule for a term that has no rule.
    """
    parts = read_parts(frame)
    wholes: dict[Special, Expr] = {}
    for term, factors in parts.special.items():
        look()
        whole = _whole(frame, term, factors)
        if whole != 0:
            wholes[term] = whole
    found = _of_polynomials(frame, parts.polynomials, look)
    for name, (scale, weights) in WEIGHTS.items():
        for term, whole in wholes.items():
            look()
            for value, coefficient in term.weighted(whole, weights).items():
                found[name] += factor(scale * coefficient) * value
    return found


# ------------------------------------------------------------------ reading g'


def read_parts(frame: Frame) -> Parts:
    """Write g' as polynomials and special terms.

    Raises NoRule.
    """
    pieces = frame.slope.pieces
    parts = Parts([S.Zero] * len(pieces))
    for number, piece in enumerate(pieces):
        slope = expand(piece.slope, power_base=False, power_exp=False, log=False)
        for term in Add.make_args(slope):
            parts.add(number, *_read(frame, term))
    return parts


def _read(frame: Frame, term: Expr) -> tuple[Special | None, Expr]:
    """Split a term into a special term and its polynomial factor."""
    polynomial, special = S.One, []
    for base, exponent in term.as_powers_dict().items():
        power = base**exponent
        if not power.has(x) or power.is_polynomial(x):
            polynomial *= power
        else:
            special.append((base, exponent))
    if not special:
        return None, expand(polynomial)
    if len(special) > 1:
        ratio, special = _as_one_power(special)
        polynomial *= ratio
    if len(special) == 1:
        for rule in _RULES:
            found = rule(frame, *special[0])
            if found is not None:
                return found[0], expand(polynomial * found[1])
    raise NoRule(str(term))


def _as_one_power(powers: list[tuple[Expr, Expr]]) -> tuple[Expr, list[tuple[Expr, Expr]]]:
    """Combine powers whose bases are multiples of each other: (-x)**k/x is -(-x)**(k - 1)."""
    (base, exponent), *others = sorted(powers, key=lambda p: bool(p[1].is_integer))
    leaves, left = S.One, []
    for other, power in others:
        ratio = cancel(other / base)
        if power.is_integer and not ratio.has(x):
            leaves, exponent = leaves * ratio**power, exponent + power
        else:
            left.append((other, power))
    return leaves, [(base, exponent), *left]


Found = tuple[Special, Expr] | None
"""A special term and the remaining factor; None if a rule does not apply."""


def _power(frame: Frame, base: Expr, exponent: Expr) -> Found:
    """(beta x + delta)**p = |beta|**p (side (x - place))**p."""
    if exponent.has(x) or not base.is_polynomial(x):
        return None
    whole = factor(base)
    if whole.is_Pow and exponent.is_integer:
        base, exponent = whole.base, exponent * whole.exp
    if Poly(base, x).degree() != 1:
        return None
    beta, delta = Poly(base, x).all_coeffs()
    if not (beta.is_positive or beta.is_negative):
        return None
    side, place = (1 if beta.is_positive else -1), simplify(-delta / beta)
    at_ends = [s for s, end in zip((1, -1), frame.slope.domain, strict=True) if _same(end, place)]
    if exponent.is_integer:  # a pole, which is real on both sides
        if not at_ends:
            return None
        side = at_ends[0]
    return Power(place, side, exponent, side in at_ends), (beta * side) ** exponent


def _same(end: Expr, place: Expr) -> bool:
    """Whether an end of the body lies at a point."""
    return bool(simplify(end - place) == 0)


def _exponential(frame: Frame, base: Expr, exponent: Expr) -> Found:
    """exp, sinh or cosh of a linear argument."""
    if base == E:
        kind, argument = exp, exponent
    elif base.func in (exp, sinh, cosh) and exponent.is_number:
        kind, argument = base.func, base.args[0]
        if kind == exp:
            argument *= exponent
        elif exponent != 1:
            return None
    else:
        return None
    linear = argument.is_polynomial(x) and Poly(argument, x).degree() == 1
    return (Exponential(kind, argument), S.One) if linear else None


def _root(frame: Frame, base: Expr, exponent: Expr) -> Found:
    """An odd power of the square root of a quadratic."""
    for root in frame.roots:
        if (2 * exponent).is_odd and expand(base - root.quadratic) == 0:
            level = -exponent - Rational(1, 2)
            over = root.quadratic ** max(-level, 0)
            return Root(root, int(max(level, 0))), over
    return None


_RULES: tuple[Callable[[Frame, Expr, Expr], Found], ...] = (_power, _exponential, _root)


def _whole(frame: Frame, term: Special, factors: list[Expr]) -> Expr:
    """The factor of a special term, which must be the same wherever the term can occur.

    Raises NoRule if it is not.
    """
    acts = [True] * len(factors)
    if isinstance(term, Power) and not term.outside:
        inner = [p.lower if term.side > 0 else p.upper for p in frame.slope.pieces]
        starts = [i for i, end in enumerate(inner) if end.is_finite and end - term.place == 0]
        if not starts:
            raise NoRule(f"{term.term}, which does not begin at a kink")
        indices = range(len(factors))
        acts = [i >= starts[0] if term.side > 0 else i <= starts[0] for i in indices]
    whole = factors[acts.index(True)]
    for here, held in zip(factors, acts, strict=True):
        if simplify(here - (whole if held else 0)) != 0:
            raise NoRule(f"{term.term}, which changes at a kink")
    return whole


# ------------------------------------------------------------------ integrals of the polynomials


def _of_polynomials(frame: Frame, pieces: list[Expr], look: LookAtClock) -> dict[str, Expr]:
    """The contribution of the polynomials to every formula: those of a body with their slope."""
    base = pieces[sum(k.kink.side < 0 for k in frame.kinks)]
    steps = zip(frame.slope.kinks, pairwise(pieces), strict=True)
    kinks = (replace(kink, jump=expand(kink.side * (q - p))) for kink, (p, q) in steps)
    alone = Frame(replace(frame.slope, base=base, kinks=tuple(kinks)))
    if not any((base, *(kink.jump for kink in alone.slope.kinks))):
        return dict.fromkeys(WEIGHTS, S.Zero)
    found = {}
    for name in WEIGHTS:
        look()
        found[name] = contact_formula(alone, name)
    return found
