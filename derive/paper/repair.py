"""Generate equations that differ from a printed one by a likely misprint.

    kind       changes that are tried
    --------   ------------------------------------------------------------------
    sign       opposite sign of the whole expression, of each term and of each function
    factor     2, 3, 4, 8, sqrt 2, pi and 2 pi, or their reciprocals, on the whole expression;
               2, pi and 4, or their reciprocals, on a term
    swap       one symbol replaced by another, everywhere or in one place; two symbols exchanged;
               a symbol replaced by its reciprocal, or by the mean of it and another symbol
    exponent   of every power: opposite sign, multiplied by 2, 1/2, 3/2 or 2/3, plus or minus one;
               2, 1/2 or -1 on a symbol; a square root of a sum or of the whole expression
    term       one term removed, or one symbol added
    modulus    one modulus removed, or one added around the whole expression

The changes do not depend on the paper.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, permutations

from sympy import Abs, Add, Expr, Integral, Mul, Number, Pow, Rational, S, Symbol, pi, sqrt

KINDS = ("sign", "factor", "swap", "exponent", "term", "modulus")
"""The kinds of changes, in the order of preference."""

_FACTORS = tuple(f for n in (S(2), pi, S(4), S(3), 2 * pi, S(8), sqrt(2)) for f in (n, 1 / n))
_OF_A_TERM = _FACTORS[:6]


@dataclass(frozen=True)
class Edit:
    """One change of an expression."""

    kind: str
    what: str
    expr: Expr


def edits(expr: Expr, swaps: Iterable[Symbol] = ()) -> Iterator[Edit]:
    """Yield all changes of one side; each differs from `expr` and from all others."""
    return _distinct(expr, _all(expr, tuple(swaps)))


def plain_edits(expr: Expr, swaps: Iterable[Symbol] = ()) -> Iterator[Edit]:
    """Yield the changes that are tried in pairs: signs, swaps and factors on the whole."""
    groups = (_signs(expr), _swapped(expr, tuple(swaps)), _whole_factors(expr))
    return _distinct(expr, chain(*groups))


def _distinct(expr: Expr, candidates: Iterable[Edit]) -> Iterator[Edit]:
    seen = {expr}
    for edit in candidates:
        if edit.expr not in seen and not edit.expr.has(S.NaN, S.ComplexInfinity):
            seen.add(edit.expr)
            yield edit


def _all(expr: Expr, swaps: tuple[Symbol, ...]) -> Iterator[Edit]:
    yield from _signs(expr)
    yield from _whole_factors(expr)
    yield from _factors(expr)
    yield from _swapped(expr, swaps)
    yield from _exponents(expr)
    yield from _lost_roots(expr)
    yield from _terms(expr, swaps)
    yield from _moduli(expr)


def _places(expr: Expr, kind: type) -> list[Expr]:
    """Return the parts of one type, in an order that is the same in every run."""
    return sorted(expr.atoms(kind), key=lambda part: (len(str(part)), str(part)))


def _put(expr: Expr, part: Expr, other: Expr) -> Expr:
    return expr.xreplace({part: other})


def _signs(expr: Expr) -> Iterator[Edit]:
    yield Edit("sign", "of the whole", -expr)
    for total in _places(expr, Add):
        for term in total.args:
            yield Edit("sign", f"of {term}", _put(expr, total, total - 2 * term))
    for call in _functions(expr):
        yield Edit("sign", f"of {call}", _put(expr, call, -call))


def _functions(expr: Expr) -> list[Expr]:
    functions = [n for n in _walk(expr) if n.is_Function or isinstance(n, Integral)]
    return sorted(set(functions), key=str)


def _walk(expr: Expr) -> Iterator[Expr]:
    yield expr
    for arg in expr.args:
        if isinstance(arg, Expr):
            yield from _walk(arg)


def _whole_factors(expr: Expr) -> Iterator[Edit]:
    for factor in _FACTORS:
        yield Edit("factor", f"{factor} on the whole", factor * expr)


def _factors(expr: Expr) -> Iterator[Edit]:
    for total in _places(expr, Add):
        for term in total.args:
            for factor in _OF_A_TERM:
                changed = _put(expr, total, total + (factor - 1) * term)
                yield Edit("factor", f"{factor} on {term}", changed)


def _swapped(expr: Expr, swaps: tuple[Symbol, ...]) -> Iterator[Edit]:
    held = [s for s in swaps if expr.has(s)]
    for one, other in permutations(swaps, 2):
        if expr.has(one):
            yield Edit("swap", f"{other} for {one}", expr.xreplace({one: other}))
    for one, other in permutations(held, 2):
        if str(one) < str(other):
            both = expr.xreplace({one: other, other: one})
            yield Edit("swap", f"{one} and {other} exchanged", both)
    for one, other in permutations(swaps, 2):
        if expr.has(one):
            mean = (one + other) / 2
            yield Edit("swap", f"{mean} for {one}", expr.xreplace({one: mean}))
            yield from _in_one_place(expr, one, other)
    for over in _places(expr, Integral):
        for edit in _swapped(over.function, swaps):
            inside = Integral(edit.expr, *over.limits)
            yield Edit("swap", f"{edit.what} under the integral", _put(expr, over, inside))
    for one in held:
        yield Edit("swap", f"{1 / one} for {one}", expr.xreplace({one: 1 / one}))


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
            for changed in (-exp, 2 * exp, exp / 2, 3 * exp / 2, 2 * exp / 3, exp + 1, exp - 1):
                yield Edit("exponent", f"{changed} on {base}", _put(expr, power, base**changed))
    for symbol in sorted((s for s in expr.free_symbols if isinstance(s, Symbol)), key=str):
        for changed in (S(2), Rational(1, 2), S(-1)):
            yield Edit(
                "exponent", f"{changed} on {symbol}", expr.xreplace({symbol: symbol**changed})
            )


def _lost_roots(expr: Expr) -> Iterator[Edit]:
    for total in [*_places(expr, Add), expr]:
        yield Edit("exponent", f"1/2 on {total}", _put(expr, total, sqrt(total)))


def _terms(expr: Expr, swaps: tuple[Symbol, ...]) -> Iterator[Edit]:
    for total in _places(expr, Add):
        for term in total.args:
            yield Edit("term", f"without {term}", _put(expr, total, total - term))
        for symbol in swaps:
            for sign, word in ((1, "plus"), (-1, "minus")):
                changed = _put(expr, total, total + sign * symbol)
                yield Edit("term", f"{word} {symbol} in {total}", changed)


def _moduli(expr: Expr) -> Iterator[Edit]:
    yield Edit("modulus", "around the whole", Abs(expr))
    for modulus in _places(expr, Abs):
        for sign in (1, -1):
            inside = sign * modulus.args[0]
            yield Edit("modulus", f"{inside} for {modulus}", _put(expr, modulus, inside))
