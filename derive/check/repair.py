"""Generate equations that differ from a printed one by a likely misprint.

Each rule in the table at the end is a kind of change, the places where it is made, and what is
written there instead.  The rules do not depend on the paper.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from sympy import (
    Abs,
    Add,
    Basic,
    Expr,
    Integral,
    Mul,
    Pow,
    Rational,
    S,
    Symbol,
    pi,
    powdenest,
    preorder_traversal,
    sign,
    sqrt,
)

from derive.reading.improper import typed
from derive.reading.units import NUMBER, Dimension
from derive.reading.words import FUNCTIONS

WHOLE = "the whole expression"
"""The end of `Edit.what` for a change of a whole side."""

KINDS = (
    *("sign", "limit", "factor", "swap", "function", "exponent"),
    *("angle", "term", "modulus", "relation"),
)
"""The kinds of changes, in the order of preference."""

_FACTORS = tuple(
    f for n in (S(2), pi, S(4), S(3), 2 * pi, S(8), sqrt(2), sqrt(pi)) for f in (n, 1 / n)
)
_OF_A_TERM, _OF_A_ROOT = _FACTORS[:6], _FACTORS[12:]
_MULTIPLES = S(2), S.Half, Rational(3, 2), Rational(2, 3)
"""Multiples of an exponent that may have been intended."""
_LIKE = {each.of_sympy: each.like for each in FUNCTIONS.values() if each.like}
"""The family of each function; those of one family may have been confused with each other."""

_LOST = tuple(sign * n for n in (S.One, S.Half, S(2)) for sign in (1, -1))
"""Powers of a name that may have been lost, or that is printed once too often."""


@dataclass(frozen=True)
class Names:
    """The names in an equation.

    swaps  names that may have been confused with each other
    units  the units of the names, where they are known
    fits   if the units of the equation do not fit: whether they fit with another expression
    """

    swaps: Sequence[Symbol] = ()
    units: Mapping[Symbol, Dimension] = field(default_factory=dict)
    fits: Callable[[Expr], bool] | None = None

    def others(self, one: Symbol) -> list[Symbol]:
        """Return the names that may replace one; those of another unit if the units do not fit."""
        own = {} if self.fits else self.units
        alike = (n for n in self.swaps if len({own[m] for m in {one, n} & own.keys()}) < 2)
        return [name for name in alike if name != one]


@dataclass(frozen=True)
class Edit:
    """One change of an expression: its kind, what is changed, and the result."""

    kind: str
    what: str
    expr: Expr


@dataclass(frozen=True)
class Place:
    """A part of an expression that is changed.

    role    what is changed everywhere: the whole, a name, a call, or a part (a sum, a power or a
            product); or what is changed in one place only: a term of a sum, an argument of a call,
            the integrand or an end of an integral
    within  this place; None if it is changed everywhere
    """

    role: str
    part: Expr
    within: Basic | None = None

    def __str__(self) -> str:
        return WHOLE if self.role == "whole" else str(typed(self.part))

    def put(self, expr: Expr, other: Expr) -> Expr:
        """Return `expr` with the other part."""
        if self.within is None:
            return expr.xreplace({self.part: other})
        args = (other if arg == self.part else arg for arg in self.within.args)
        return expr.xreplace({self.within: self.within.func(*args)})


def _places(expr: Expr) -> list[Place]:
    """Return all places of an expression, in an order that is the same in every run."""
    every = {node for node in preorder_traversal(expr) if isinstance(node, Expr)}
    nodes = sorted(every, key=_by_length)
    calls = [node for node in nodes if node.is_Function or isinstance(node, Integral)]
    arguments = {arg for call in calls for arg in call.args}
    found = [Place("whole", expr)]
    found += [Place("name", node) for node in nodes if node in expr.free_symbols]
    found += [Place("call", node) for node in calls]
    parts = [node for node in nodes if isinstance(node, Add | Pow | Mul)]
    found += [Place("part", node) for node in parts if not (node.is_Mul and node in arguments)]
    for node in nodes:
        if isinstance(node, Integral):
            found.append(Place("integrand", node.function, node))
            found += [Place("end", end, each) for each in node.limits for end in each[1:]]
        elif isinstance(node, Add) or node in calls:
            role = "term" if isinstance(node, Add) else "argument"
            found += [Place(role, arg, node) for arg in node.args if isinstance(arg, Expr)]
    return found


def _by_length(part: Basic) -> tuple[int, str]:
    return len(str(part)), str(part)


def edits(expr: Expr, names: Names | None = None) -> Iterator[Edit]:
    """Yield all changes of one side; each differs from `expr` and from all others."""
    seen, names, every = {expr}, names or Names(), _places(expr)
    for kind, roles, changes in _RULES:
        for place in (each for role in roles.split() for each in every if each.role == role):
            for what, other in changes(place, names):
                changed = place.put(expr, other)
                if changed in seen or changed.has(S.NaN, S.ComplexInfinity):
                    continue
                if changes is _lost and names.fits and not names.fits(changed):
                    continue
                seen.add(changed)
                yield Edit(kind, what, changed)


# ------------------------------------------------------------------ changes

_Changed = Iterable[tuple[str, Expr]]
"""What is changed, in words, and what is written in that place."""


def _scaled(place: Place, names: Names) -> _Changed:
    """Write another factor, or make the number of a term larger or smaller by one."""
    factors = [*(_OF_A_TERM if place.within else _FACTORS)]
    if place.within and any(n.exp.is_Rational and n.exp.q > 1 for n in place.part.atoms(Pow)):
        factors += _OF_A_ROOT
    number = place.part.as_coeff_Mul()[0]
    if number.is_Rational and number != 0:
        over, under = number.p, number.q
        others = [Rational(n, under) for n in (over + 1, over - 1)]
        others += [Rational(over, n) for n in (under + 1, under - 1) if n]
        factors += [other / number for other in others if other != 0]
    for factor in factors:
        yield f"{factor} on {place}", factor * place.part


def _argument_scaled(place: Place, names: Names) -> _Changed:
    call = place.part
    if len(call.args) == 1 and not isinstance(call, Abs | sign):
        for factor in (S(2), S.Half):
            yield f"{factor} on the argument of {place}", call.func(factor * call.args[0])


def _swapped(place: Place, names: Names) -> _Changed:
    """Write one name for another, exchange two, or write the mean of both or the reciprocal."""
    expr, end = place.part, " under the integral" if place.within else ""
    held = [name for name in names.swaps if expr.has(name)]
    pairs = [(one, other) for one in held for other in names.others(one)]
    parts = sorted(expr.atoms(Add, Mul, Pow), key=_by_length)
    for one, other in pairs:
        yield f"{other} for {one}{end}", expr.xreplace({one: other})
    for one, other in pairs:
        if other in held and str(one) < str(other):
            yield f"{one} and {other} exchanged{end}", expr.xreplace({one: other, other: one})
    for one, other in pairs:
        mean = (one + other) / 2
        yield f"{mean} for {one}{end}", expr.xreplace({one: mean})
        for inner in (Place("part", arg, each) for each in parts for arg in each.args):
            changed = inner.put(expr, inner.part.xreplace({one: other}))
            yield f"{other} for {one} in {inner}{end}", changed
    for one in held:
        yield f"{1 / one} for {one}{end}", expr.xreplace({one: 1 / one})


def _other_function(place: Place, names: Names) -> _Changed:
    call = place.part
    for other, family in _LIKE.items():
        if other != call.func and family == _LIKE.get(call.func):
            yield f"{other.__name__} for {place}", other(*call.args)


def _complement(place: Place, names: Names) -> _Changed:
    if names.units.get(place.part) == NUMBER:
        yield f"{pi / 2 - place.part} for {place}", pi / 2 - place.part


def _lost(place: Place, names: Names) -> _Changed:
    """Write a power of one name as another factor; the units decide which one fits."""
    for name, unit in names.units.items() if names.fits else ():
        if unit != NUMBER:
            yield from ((f"{name**n} on {place}", name**n * place.part) for n in _LOST)


def _other_ratio(place: Place, names: Names) -> _Changed:
    """Write the quotient of two names with the same unit as another factor of a term."""
    held = [name for name in names.swaps if name in names.units and place.part.has(name)]
    for one in held:
        for other in names.others(one):
            if names.units.get(other) == names.units[one] != NUMBER:
                yield from ((f"{n} on {place}", n * place.part) for n in (one / other, other / one))


def _other_end(place: Place, names: Names) -> _Changed:
    """Write zero, another name, or the opposite of one or of the other end, but not this end."""
    ends = [-end for end in place.within.args[1:]] if place.within else []
    alike = [n for n, unit in names.units.items() if unit == names.units.get(place.part)]
    others = [n for n in dict.fromkeys((*names.swaps, *alike)) if n != place.part]
    for end in (S.Zero, *ends, *others, *(-name for name in others)):
        if -end in ends:
            continue
        yield f"{end} for {place} as an end of the integral", end


def _other_exponent(place: Place, names: Names) -> _Changed:
    """Change the exponent of a factor, or of all factors with the same modulus of it.

    These may have been a bracket, perhaps with a number, over which SymPy distributes its exponent.
    """
    number, rest = place.part.as_coeff_Mul()
    end = f" in {place.within}" if place.within else ""
    powers = [n.as_base_exp() for n in Mul.make_args(rest)]
    powers = [(base, e) for base, e in powers if e.is_Rational and e != 0]
    groups = [[(base, e)] for base, e in powers if not base.is_Function or e != 1]
    groups += [[p for p in powers if abs(p[1]) == n] for n in sorted({abs(e) for _, e in powers})]
    for group in groups:
        size = abs(group[0][1])
        inside = Mul(*(base ** (e / size) for base, e in group))
        with_number = abs(number) ** (1 / size) * inside
        others = {-size, 1 / size, size + 1, size - 1, *(n * size for n in _MULTIPLES)} - {0}
        for before, bracket in ((number, inside), (sign(number), with_number)):
            for other in sorted(others):
                changed = before * (rest / inside**size) * bracket**other
                yield f"{other} on {bracket}{end}", changed


def _on_each_term(place: Place, names: Names) -> _Changed:
    """Write u**n - v**n for (u - v)**n."""
    base, power = place.part.as_base_exp()
    if base.is_Add and len(base.args) == 2 and power.is_Rational:
        yield f"{power} on each term of {base}", Add(*(_raised(n, power) for n in base.args))


def _raised(term: Expr, power: Expr) -> Expr:
    """Return a power of a term, which keeps its sign."""
    sign_ = -1 if term.could_extract_minus_sign() else 1
    return sign_ * powdenest((sign_ * term) ** power, force=True)


def _upside_down(place: Place, names: Names) -> _Changed:
    """Exchange a factor and a divisor."""
    factors = Mul.make_args(place.part.as_coeff_Mul()[1])
    divisors = [n for n in factors if isinstance(n, Pow) and n.exp.is_negative]
    for factor in (n for n in factors if n not in divisors):
        for divisor in divisors:
            changed = Mul(*(1 / n if n in (factor, divisor) else n for n in place.part.args))
            yield f"{factor} and {1 / divisor} exchanged", changed


def _other_modulus(place: Place, names: Names) -> _Changed:
    """Write the modulus of a whole side, or leave one out."""
    if place.role == "whole":
        yield f"around {place}", Abs(place.part)
    elif isinstance(place.part, Abs):
        yield from ((f"{n} for {place}", n) for n in (place.part.args[0], -place.part.args[0]))


_RULES: tuple[tuple[str, str, Callable[[Place, Names], _Changed]], ...] = (
    ("sign", "whole term call", lambda p, _: [(f"of {p}", -p.part)]),
    ("swap", "whole integrand", _swapped),
    ("factor", "whole term", _scaled),
    ("factor", "call", _argument_scaled),
    ("factor", "whole term argument", _lost),
    ("factor", "term", _other_ratio),
    ("function", "call", _other_function),
    ("exponent", "whole name part term", _other_exponent),
    ("exponent", "part", _on_each_term),
    ("exponent", "whole part argument", _upside_down),
    ("angle", "name", _complement),
    ("term", "term", lambda p, _: [(f"without {p}", S.Zero)]),
    ("modulus", "whole call", _other_modulus),
    ("limit", "end", _other_end),
)
