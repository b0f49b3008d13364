"""Generate equations that differ from a printed one by a likely misprint.

Each rule in the table at the end is a kind of change, the places where it is made, and what is
written there instead.  The rules do not depend on the paper.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain

from sympy import (
    Abs,
    Add,
    Basic,
    Expr,
    Function,
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

    swaps  for each name that may have been confused with others, these others
    units  the units of the names, where they are known
    fits   if the units of the equation do not fit: whether they fit with another expression
    """

    swaps: Mapping[Symbol, Sequence[Symbol]] = field(default_factory=dict)
    units: Mapping[Symbol, Dimension] = field(default_factory=dict)
    fits: Callable[[Expr], bool] | None = None


@dataclass(frozen=True)
class Edit:
    """One change of an expression: its kind, what is changed, and the result."""

    kind: str
    what: str
    expr: Expr


@dataclass(frozen=True)
class Place:
    """A part of an expression that is changed.

    within  the only sum, product, power, call or range of an integral in which it is changed; None
            for all
    name    the part in words
    """

    part: Expr
    within: Basic | None = None
    name: str = ""

    def __str__(self) -> str:
        return self.name or str(typed(self.part))

    def put(self, expr: Expr, other: Expr) -> Expr:
        """Return `expr` with the other part."""
        if self.within is None:
            return expr.xreplace({self.part: other})
        args = (other if arg == self.part else arg for arg in self.within.args)
        return expr.xreplace({self.within: self.within.func(*args)})


_Places = Callable[[Expr], Iterable[Place]]
_Changed = Iterable[tuple[str, Expr]]
"""What is changed, in words, and what is written in that place."""


def swappable(
    names: Sequence[Symbol],
    units: Mapping[Symbol, Dimension],
    fits: Callable[[Expr], bool] | None = None,
) -> Names:
    """Return for each name the others; those of another unit only if the units do not fit."""
    own = {} if fits else units
    swaps = {
        one: [n for n in names if n != one and len({own[m] for m in {one, n} & own.keys()}) < 2]
        for one in names
    }
    return Names(swaps, units, fits)


def edits(expr: Expr, names: Names | None = None) -> Iterator[Edit]:
    """Yield all changes of one side; each differs from `expr` and from all others."""
    seen, names = {expr}, names or Names()
    for kind, places, changes in _RULES:
        for place in places(expr):
            for what, other in changes(place, names):
                changed = place.put(expr, other)
                if changed in seen or changed.has(S.NaN, S.ComplexInfinity):
                    continue
                if changes is _lost and names.fits and not names.fits(changed):
                    continue
                seen.add(changed)
                yield Edit(kind, what, changed)


# ------------------------------------------------------------------ places


def _whole(expr: Expr) -> list[Place]:
    return [Place(expr, name=WHOLE)]


def _names(expr: Expr) -> list[Place]:
    return [Place(symbol) for symbol in sorted(expr.free_symbols, key=str)]


def _calls(expr: Expr) -> list[Place]:
    every = {n for n in preorder_traversal(expr) if isinstance(n, Expr)}
    return [Place(n) for n in sorted(every, key=str) if n.is_Function or isinstance(n, Integral)]


def _all(kind: type) -> _Places:
    """Return the rule for the parts of one type, in an order that is the same in every run."""
    return lambda expr: [
        Place(part) for part in sorted(expr.atoms(kind), key=lambda p: (len(str(p)), str(p)))
    ]


def _inside(*kinds: type, of: type = Expr) -> _Places:
    """Return the rule for the arguments of one type in all parts of some types."""
    return lambda expr: [
        Place(arg, place.part)
        for place in chain.from_iterable(_all(kind)(expr) for kind in kinds)
        for arg in place.part.args
        if isinstance(arg, of)
    ]


def _ends(expr: Expr) -> list[Place]:
    """Return the ends of all integrals."""
    limits = (limit for over in _all(Integral)(expr) for limit in over.part.args[1:])
    return [Place(end, limit) for limit in limits for end in limit.args[1:]]


def _brackets(expr: Expr) -> list[Place]:
    """Return the products, except those that are arguments of functions."""
    arguments = {arg for call in _calls(expr) for arg in call.part.args}
    return [place for place in _all(Mul)(expr) if place.part not in arguments]


def _any(*rules: _Places) -> _Places:
    return lambda expr: chain.from_iterable(rule(expr) for rule in rules)


# ------------------------------------------------------------------ changes


def _scaled(place: Place, names: Names) -> _Changed:
    """Write another factor, or make the number of a term larger or smaller by one."""
    factors = [*(_FACTORS if place.within is None else _OF_A_TERM)]
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
    pairs = [(one, other) for one in held for other in names.swaps[one]]
    for one, other in pairs:
        yield f"{other} for {one}{end}", expr.xreplace({one: other})
    for one, other in pairs:
        if other in held and str(one) < str(other):
            yield f"{one} and {other} exchanged{end}", expr.xreplace({one: other, other: one})
    for one, other in pairs:
        mean = (one + other) / 2
        yield f"{mean} for {one}{end}", expr.xreplace({one: mean})
        for inner in _inside(Add, Mul, Pow)(expr):
            if inner.part.has(one):
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
        for other in names.swaps[one]:
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


def _in_bracket(place: Place, names: Names) -> _Changed:
    """Write (u - v)**n for u**n - v**n, or the other way round."""
    base, power = place.part.as_base_exp()
    if len(base.args) != 2:
        return
    if power.is_Rational and base.is_Add:
        yield f"{power} on each term of {base}", Add(*(_raised(n, power) for n in base.args))
    for number in (2, 3, S.Half) if place.part.is_Add else ():
        terms = [_raised(n, S.One / number) for n in place.part.args]
        yield f"{number} on {Add(*terms)}", Add(*terms) ** number


def _raised(term: Expr, power: Expr) -> Expr:
    """Return a power of a term, which keeps its sign."""
    sign_ = -1 if term.could_extract_minus_sign() else 1
    return sign_ * powdenest((sign_ * term) ** power, force=True)


def _upside_down(place: Place, names: Names) -> _Changed:
    """Invert the number of a product, or exchange a factor and a divisor."""
    number, rest = place.part.as_coeff_Mul()
    if number not in (1, -1):
        yield f"-1 on {number}", rest / number
    divisors = [n for n in Mul.make_args(rest) if isinstance(n, Pow) and n.exp.is_negative]
    for factor in (n for n in Mul.make_args(rest) if n not in divisors and rest != n):
        for divisor in divisors:
            changed = Mul(*(1 / n if n in (factor, divisor) else n for n in place.part.args))
            yield f"{factor} and {1 / divisor} exchanged", changed


_RULES: tuple[tuple[str, _Places, Callable[[Place, Names], _Changed]], ...] = (
    ("sign", _any(_whole, _inside(Add), _calls), lambda p, _: [(f"of {p}", -p.part)]),
    ("swap", _any(_whole, _inside(Integral)), _swapped),
    ("factor", _whole, _scaled),
    ("factor", _inside(Add), _scaled),
    ("factor", _calls, _argument_scaled),
    ("factor", _any(_whole, _inside(Add, Function)), _lost),
    ("factor", _inside(Add), _other_ratio),
    ("function", _calls, _other_function),
    ("exponent", _any(_whole, _names, _all(Add), _all(Pow), _brackets), _other_exponent),
    ("exponent", _inside(Add, of=Symbol), _other_exponent),
    ("exponent", _any(_all(Pow), _all(Add)), _in_bracket),
    ("exponent", _all(Mul), _upside_down),
    ("angle", _names, _complement),
    ("term", _inside(Add), lambda p, _: [(f"without {p}", S.Zero)]),
    ("modulus", _whole, lambda p, _: [(f"around {p}", Abs(p.part))]),
    (
        "modulus",
        _all(Abs),
        lambda p, _: [(f"{n} for {p}", n) for n in (p.part.args[0], -p.part.args[0])],
    ),
    ("limit", _ends, _other_end),
)
