"""Generate equations that differ from a printed one by a likely misprint.

    kind       changes that are tried
    --------   ------------------------------------------------------------------
    sign       opposite sign of the whole expression, of each term and of each function
    factor     2, 3, 4, 8, sqrt 2, sqrt pi, pi and 2 pi, or their reciprocals, on the whole
               expression; 2, pi and 4, or their reciprocals, on a term, and their roots on a term
               with a root; 2, or 1/2, in a function; a number larger or smaller by one
    swap       one name replaced by another, everywhere or in one place; two names exchanged;
               a name replaced by its reciprocal, or by the mean of it and another name
    function   sine, cosine and tangent, their inverses, the hyperbolic functions and the
               complete elliptic integrals replaced by each other
    exponent   of every power: opposite sign, reciprocal, multiplied by 2, 1/2, 3/2 or 2/3, plus or
               minus one; 2, 1/2 or -1 on a symbol, everywhere or in one place; a square root of a
               sum or of the whole expression; its reciprocal; two factors exchanged, of which one
               is a divisor
    term       one term removed, or one symbol added
    modulus    one modulus removed, or one added around the whole expression

SymPy distributes a power over the factors in a bracket, so that `regrouped` changes the exponents
of brackets and roots in the printed text.  The changes do not depend on the paper.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, permutations

from sympy import (
    Abs,
    Add,
    Expr,
    Integral,
    Mul,
    Number,
    Pow,
    Rational,
    S,
    Symbol,
    pi,
    preorder_traversal,
    sign,
    sqrt,
)

from derive.reading.words import FUNCTIONS

WHOLE = "the whole expression"
"""The end of `Edit.what` for a change of a whole side."""

KINDS = ("sign", "factor", "swap", "function", "exponent", "term", "modulus")
"""The kinds of changes, in the order of preference."""

_FACTORS = tuple(
    f for n in (S(2), pi, S(4), S(3), 2 * pi, S(8), sqrt(2), sqrt(pi)) for f in (n, 1 / n)
)
_OF_A_TERM = _FACTORS[:6]
_OF_A_ROOT = _FACTORS[12:]
_LIKE = {each.of_sympy: each.like for each in FUNCTIONS.values() if each.like}
"""The family of each function; those of one family may have been confused with each other."""

Units = Mapping[Symbol, str]
"""The units of names, where they are known; names of different units are not swapped."""


def in_words(kind: str, what: str) -> str:
    """Return a change, or a pair of changes, in words.

    >>> in_words("sign and swap", "of b; c for a")
    'sign of b and swap c for a'
    """
    kinds = kind.split(" and ")
    return " and ".join(map(" ".join, zip(kinds, what.split("; ", len(kinds) - 1), strict=True)))


@dataclass(frozen=True)
class Edit:
    """One change of an expression, or two: their kinds joined by "and", and `what` by ";"."""

    kind: str
    what: str
    expr: Expr


def edits(expr: Expr, swaps: Iterable[Symbol] = (), units: Units | None = None) -> Iterator[Edit]:
    """Yield all changes of one side; each differs from `expr` and from all others."""
    return _distinct(expr, _all(expr, tuple(swaps), units or {}))


def plain_edits(
    expr: Expr, swaps: Iterable[Symbol] = (), units: Units | None = None
) -> Iterator[Edit]:
    """Yield the changes that are tried in pairs: signs, swaps and factors on a whole side."""
    groups = (_signs(expr), _swapped(expr, tuple(swaps), units or {}), _whole_factors(expr))
    return _distinct(expr, chain(*groups))


def regrouped(text: str) -> Iterator[tuple[str, str]]:
    """Yield the printed text with another exponent on one bracket or root, and the change."""
    for start, end in _brackets(text):
        inside = text[start:end]
        name = re.search(r"[A-Za-z_]\w*$", text[:start])
        if (name and name[0] != "sqrt") or text[:start].endswith("**"):
            continue  # the arguments of another function, or an exponent
        before = text[: name.start() if name else start]
        power = re.match(r"\*\*(\d+|\((-?\d+(?:/\d+)?)\))", text[end:])
        after = text[end + (power.end() if power else 0) :]
        own = (power[2] or power[1]) if power else "1/2" if name else "1"
        for other in _EXPONENTS:
            if other != own and not (name and power):
                yield f"{before}({inside}**({other})){after}", f"{other} on {inside}"


_EXPONENTS = ("1", "-1", "2", "-2", "1/2", "-1/2", "1/3", "2/3", "3/2", "3")


def _brackets(text: str) -> Iterator[tuple[int, int]]:
    """Yield the positions of all brackets in a text."""
    open_ = list[int]()
    for position, character in enumerate(text):
        if character == "(":
            open_.append(position)
        elif character == ")" and open_:
            yield open_.pop(), position + 1


def _distinct(expr: Expr, candidates: Iterable[Edit]) -> Iterator[Edit]:
    seen = {expr}
    for edit in candidates:
        if edit.expr not in seen and not edit.expr.has(S.NaN, S.ComplexInfinity):
            seen.add(edit.expr)
            yield edit


def _all(expr: Expr, swaps: tuple[Symbol, ...], units: Units) -> Iterator[Edit]:
    yield from _signs(expr)
    yield from _whole_factors(expr)
    yield from _factors(expr)
    yield from _swapped(expr, swaps, units)
    yield from _other_functions(expr)
    yield from _exponents(expr)
    yield from _in_one_factor(expr)
    yield from _upside_down(expr)
    yield from _lost_roots(expr)
    yield from _terms(expr, swaps)
    yield from _moduli(expr)


def _places(expr: Expr, kind: type) -> list[Expr]:
    """Return the parts of one type, in an order that is the same in every run."""
    return sorted(expr.atoms(kind), key=lambda part: (len(str(part)), str(part)))


def _put(expr: Expr, part: Expr, other: Expr) -> Expr:
    return expr.xreplace({part: other})


def _signs(expr: Expr) -> Iterator[Edit]:
    yield Edit("sign", f"of {WHOLE}", -expr)
    for total in _places(expr, Add):
        for term in total.args:
            yield Edit("sign", f"of {term}", _put(expr, total, total - 2 * term))
    for call in _functions(expr):
        yield Edit("sign", f"of {call}", _put(expr, call, -call))


def _functions(expr: Expr) -> list[Expr]:
    every = (n for n in preorder_traversal(expr) if isinstance(n, Expr))
    return sorted({n for n in every if n.is_Function or isinstance(n, Integral)}, key=str)


def _whole_factors(expr: Expr) -> Iterator[Edit]:
    for factor in (*_FACTORS, *_neighbours(expr)):
        yield Edit("factor", f"{factor} on {WHOLE}", factor * expr)


def _neighbours(term: Expr) -> list[Expr]:
    """Return the factors by which the number of a term becomes larger or smaller by one."""
    number = term.as_coeff_Mul()[0]
    if not number.is_Rational or number == 0:
        return []
    over, under = number.p, number.q
    changed = [Rational(n, under) for n in (over + 1, over - 1)]
    changed += [Rational(over, n) for n in (under + 1, under - 1) if n]
    return [each / number for each in changed if each != 0]


def _factors(expr: Expr) -> Iterator[Edit]:
    for total in _places(expr, Add):
        for term in total.args:
            has_root = any(n.exp.is_Rational and not n.exp.is_Integer for n in term.atoms(Pow))
            roots = _OF_A_ROOT if has_root else ()
            for factor in (*_OF_A_TERM, *roots, *_neighbours(term)):
                scaled = Add(*(factor * n if n == term else n for n in total.args))
                yield Edit("factor", f"{factor} on {term}", _put(expr, total, scaled))
    for call in _functions(expr):
        if len(call.args) == 1 and not isinstance(call, Abs | sign):
            for factor in (S(2), S.Half):
                changed = _put(expr, call, call.func(factor * call.args[0]))
                yield Edit("factor", f"{factor} on the argument of {call}", changed)


def _other_functions(expr: Expr) -> Iterator[Edit]:
    for call in _functions(expr):
        for other, family in _LIKE.items():
            if other != call.func and family == _LIKE.get(call.func):
                changed = _put(expr, call, other(*call.args))
                yield Edit("function", f"{other.__name__} for {call}", changed)


def _swapped(expr: Expr, swaps: tuple[Symbol, ...], units: Units) -> Iterator[Edit]:
    held = [s for s in swaps if expr.has(s)]
    pairs = [pair for pair in permutations(swaps, 2) if expr.has(pair[0]) and _fit(pair, units)]
    for one, other in pairs:
        yield Edit("swap", f"{other} for {one}", expr.xreplace({one: other}))
    for one, other in pairs:
        if other in held and str(one) < str(other):
            both = expr.xreplace({one: other, other: one})
            yield Edit("swap", f"{one} and {other} exchanged", both)
    for one, other in pairs:
        mean = (one + other) / 2
        yield Edit("swap", f"{mean} for {one}", expr.xreplace({one: mean}))
        yield from _in_one_place(expr, one, other)
    for over in _places(expr, Integral):
        for edit in _swapped(over.function, swaps, units):
            inside = Integral(edit.expr, *over.limits)
            yield Edit("swap", f"{edit.what} under the integral", _put(expr, over, inside))
    for one in held:
        yield Edit("swap", f"{1 / one} for {one}", expr.xreplace({one: 1 / one}))


def _fit(pair: tuple[Symbol, Symbol], units: Units) -> bool:
    """Whether two names have the same unit, as far as it is known."""
    return len({units[name] for name in pair if name in units}) < 2


def _in_one_place(expr: Expr, one: Symbol, other: Symbol) -> Iterator[Edit]:
    for total in [*_places(expr, Add), *_places(expr, Mul), *_places(expr, Pow)]:
        for part in total.args:
            if part.has(one) and part != total:
                changed = total.func(*(_swap_in(p, part, one, other) for p in total.args))
                yield Edit("swap", f"{other} for {one} in {part}", _put(expr, total, changed))


def _swap_in(arg: Expr, part: Expr, one: Symbol, other: Symbol) -> Expr:
    return arg.xreplace({one: other}) if arg == part else arg


def _exponents(expr: Expr) -> Iterator[Edit]:
    for power in _places(expr, Pow):
        base, exp = power.base, power.exp
        if isinstance(exp, Number):
            others = (-exp, 2 * exp, exp / 2, 3 * exp / 2, 2 * exp / 3, exp + 1, exp - 1, 1 / exp)
            for changed in others:
                yield Edit("exponent", f"{changed} on {base}", _put(expr, power, base**changed))
    for symbol in sorted((s for s in expr.free_symbols if isinstance(s, Symbol)), key=str):
        for changed in (S(2), Rational(1, 2), S(-1)):
            yield Edit(
                "exponent", f"{changed} on {symbol}", expr.xreplace({symbol: symbol**changed})
            )


def _in_one_factor(expr: Expr) -> Iterator[Edit]:
    """Yield changes of the exponent of a symbol in one term or factor."""
    for total in [*_places(expr, Add), *_places(expr, Mul)]:
        for part in total.args:
            if isinstance(part, Symbol):
                for exponent in (S(2), S.Half):
                    changed = total.func(*(p**exponent if p == part else p for p in total.args))
                    what = f"{exponent} on {part} in {total}"
                    yield Edit("exponent", what, _put(expr, total, changed))


def _upside_down(expr: Expr) -> Iterator[Edit]:
    """Yield reciprocals: of the whole expression, of a number, and of a factor and a divisor."""
    yield Edit("exponent", f"-1 on {WHOLE}", 1 / expr)
    for product in [n for n in _places(expr, Mul) if n.has(Symbol)]:
        number, rest = product.as_coeff_Mul()
        if number not in (1, -1):
            yield Edit("exponent", f"-1 on {number}", _put(expr, product, rest / number))
        over = [n for n in rest.args if not (isinstance(n, Pow) and n.exp.is_negative)]
        for factor in over if isinstance(rest, Mul) else ():
            for divisor in (n for n in rest.args if n not in over):
                changed = product / (factor * divisor) ** 2
                what = f"{factor} and {1 / divisor} exchanged"
                yield Edit("exponent", what, _put(expr, product, changed))


def _lost_roots(expr: Expr) -> Iterator[Edit]:
    for total in [*_places(expr, Add), expr]:
        yield Edit("exponent", f"1/2 on {total}", _put(expr, total, sqrt(total)))


def _terms(expr: Expr, swaps: tuple[Symbol, ...]) -> Iterator[Edit]:
    for total in _places(expr, Add):
        for term in total.args:
            yield Edit("term", f"without {term}", _put(expr, total, total - term))
        for symbol in swaps:
            for sense, word in ((1, "plus"), (-1, "minus")):
                changed = _put(expr, total, total + sense * symbol)
                yield Edit("term", f"{word} {symbol} in {total}", changed)


def _moduli(expr: Expr) -> Iterator[Edit]:
    yield Edit("modulus", f"around {WHOLE}", Abs(expr))
    for modulus in _places(expr, Abs):
        for sense in (1, -1):
            inside = sense * modulus.args[0]
            yield Edit("modulus", f"{inside} for {modulus}", _put(expr, modulus, inside))
