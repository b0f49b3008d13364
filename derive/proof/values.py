"""Expressions in numbers whose digits are certain, with integrals by quadrature.

In:  an expression, and numbers for its symbols.
Out: a ball with its value, or a number all of whose working digits are known.

An expression becomes a list of steps on balls.  If rounding or cancellation leaves too few digits
of the value, the steps are repeated with more of them.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, lru_cache, reduce
from itertools import pairwise
from operator import add, mul
from typing import Any

import mpmath
from flint import acb, arb, ctx
from mpmath import mpc, mpf
from sympy import (
    Add,
    Basic,
    Derivative,
    DiracDelta,
    Expr,
    Float,
    I,
    Integral,
    Mul,
    Piecewise,
    Pow,
    Rational,
    S,
    Symbol,
    lambdify,
    nan,
    oo,
    pi,
    zoo,
)
from sympy.core.function import AppliedUndef
from sympy.core.numbers import Exp1
from sympy.logic.boolalg import Boolean, BooleanAtom

from derive.proof.balls import (
    FUNCTIONS,
    Ball,
    Function,
    Operation,
    Value,
    ball,
    digits,
    hull,
    known_digits,
    number,
    power,
    power_over,
    product,
    root,
    root_over,
)
from derive.proof.kinks import places
from derive.proof.rule import checked, integral

Numbers = Mapping[Symbol, Any]
"""Numbers of mpmath, or balls, for symbols."""
Step = tuple[int, Callable[[list[Any]], Any]]
"""The number of a value, and how it is computed from the values before it."""

_GUARD = 6
"""Additional digits of a first attempt."""
_ATTEMPTS = (1, 2, 4)
"""Multiples of the working digits that are tried until enough digits are certain."""
_FARTHEST = 2**20
"""The largest magnitude of the binary exponent of a value."""
_LOOKED_AT = 3000
"""Largest number of intervals that are searched for the zeros of a switch."""
_NEAR = (mpf(10) ** -9, mpf(10) ** -13)
"""Distances from a cut, relative to the part, at which the growth towards it is measured."""
_STEEPEST = 0.97
"""An integral is taken to diverge if the integrand grows by a higher power of 1/distance."""
_SMOOTH = {"kink", "peak"}
"""Kinds of cuts beside which an integrand is bounded."""


class Undecided(ArithmeticError):
    """No reliable value was obtained, for example because too many digits were lost."""


class Undefined(Undecided):
    """There is no value at this point, for example after a division by zero."""


class Defined(dict[Symbol, Any]):
    """Numbers of symbols, and of others by their definitions, as soon as they are needed.

    The latter are computed once for each number of digits.
    """

    def __init__(self, numbers: Numbers, definitions: Mapping[Symbol, Expr]) -> None:
        super().__init__(numbers)
        self._definitions = definitions
        self._known: dict[tuple[Symbol, int], Ball] = {}

    def __missing__(self, symbol: Symbol) -> Ball:
        key = symbol, ctx.prec
        if key not in self._known:
            meant = self._definitions.get(symbol, symbol)
            if meant == symbol:
                raise Undecided(f"the symbol {symbol} has no meaning")
            self._known[key] = program(meant)(self)
        return self._known[key]


def evaluated(expr: Expr, numbers: Numbers, twice: bool = True) -> Value:
    """The value to the working precision of mpmath; raises Undecided.

    twice: compute each integral twice, for a value that is not compared with another route.
    """
    working = mpmath.mp.dps
    for times in _ATTEMPTS[:2] if expr.has(Integral) else _ATTEMPTS:
        with mpmath.workdps(times * working + _GUARD), digits(times * working + _GUARD):
            found = program(expr, None, twice)(numbers)
        if not found.is_finite():
            raise Undefined("there is no value")
        if found != 0 and abs(int(abs(found).mid().man_exp()[1])) > _FARTHEST:
            raise Undecided("a number is too large or too small for the computation")
        if known_digits(found) >= working:
            return +number(found)
    if not found.contains(0) or abs(found).upper() > arb(10) ** -working:
        raise Undecided(f"cancellation leaves fewer than {working} digits")
    return mpf(0)


# ------------------------------------------------------------------ programs


class Program:
    """An expression as steps on balls; repeated subexpressions are computed once.

    If `along` is given, steps that do not depend on this symbol are done once for all its values.
    Of a function by branches only those that may be taken are computed.
    twice: whether each integral is computed twice, to know its digits.
    boxes: whether balls stand for all numbers in them, and not for one that is rounded.
    """

    def __init__(self, expr: Basic, along: Symbol | None, twice: bool, boxes: bool) -> None:
        self._along, self._twice, self._boxes = along, twice, boxes
        symbols = sorted(expr.free_symbols, key=str)
        self._number: dict[Basic, int] = {symbol: n for n, symbol in enumerate(symbols)}
        self._given = [(n, symbol) for n, symbol in enumerate(symbols) if symbol != along]
        self._moves = [symbol == along for symbol in symbols]
        self._steps: dict[bool, list[Step]] = {False: [], True: []}
        self._last = self._add(expr)

    def _add(self, node: Basic) -> int:
        """Add the steps for a part of the expression; return the number of its value."""
        if node not in self._number:
            if isinstance(node, Piecewise):
                place = self._add_branches(node)
            elif isinstance(node, Add | Mul):
                place, *others = sorted(map(self._add, node.args), key=self._moves.__getitem__)
                for other in others:
                    place = self._add_operation(_OF_TWO[node.func], place, other)
            else:
                operation, parts = self._operation(node)
                place = self._add_operation(operation, *map(self._add, parts))
            self._number[node] = place
        return self._number[node]

    def _add_operation(self, operation: Operation, *args: int) -> int:
        """Add the step that computes a value from the values of these numbers."""
        moves = any(self._moves[arg] for arg in args)
        if len(args) == 2:
            one, other = args
            return self._add_step(lambda values: operation(values[one], values[other]), moves)
        if len(args) == 1:
            (one,) = args
            return self._add_step(lambda values: operation(values[one]), moves)
        return self._add_step(lambda values: operation(*[values[arg] for arg in args]), moves)

    def _add_step(self, computed: Callable[[list[Any]], Any], moves: bool) -> int:
        place = len(self._moves)
        self._moves.append(moves)
        self._steps[moves].append((place, computed))
        return place

    def _add_branches(self, node: Piecewise) -> int:
        moves = self._along in node.free_symbols
        branches = [self._branch(pair.expr, pair.cond, moves) for pair in node.args]

        def computed(values: list[Any]) -> Ball:
            taken = []
            for condition, steps, found in branches:
                if values[condition] is not False:
                    taken.append(_filled(values, steps)[found])
                if values[condition] is True:
                    break
            return reduce(hull, taken) if taken else arb("nan")

        return self._add_step(computed, moves)

    def _branch(self, value: Expr, condition: Basic, moves: bool) -> tuple[int, list[Step], int]:
        """The number of a condition, the steps of its branch, and the number of their result.

        What is computed only in the branch is not known outside it.
        """
        holds = self._add(condition)
        known, outside = self._number.copy(), self._steps[moves]
        steps = self._steps[moves] = []
        found = self._add(value)
        self._number, self._steps[moves] = known, outside
        return holds, steps, found

    def _operation(self, node: Basic) -> tuple[Operation, tuple[Basic, ...]]:
        """How a part is computed, and from which parts."""
        if node in _CONSTANTS:
            return _CONSTANTS[node], ()
        if isinstance(node, BooleanAtom):
            return (lambda: bool(node)), ()
        if isinstance(node, Rational):
            return (lambda: arb(node.p) / node.q), ()
        if isinstance(node, Float):
            return (lambda: ball(mpf(node._mpf_))), ()
        if isinstance(node, Pow):
            return self._power(node)
        if node.func in FUNCTIONS:
            return FUNCTIONS[node.func], node.args
        held = tuple(sorted(node.free_symbols, key=str))
        if self._boxes:
            return (lambda *_: arb("nan")), held
        if isinstance(node, Integral):
            twice = self._twice
            return (lambda *v: _integrated(node, dict(zip(held, v, strict=True)), twice)), held
        return _by_mpmath(node), held

    def _power(self, node: Pow) -> tuple[Operation, tuple[Basic, ...]]:
        """A power; of half an integer, it is one of the root, and of an integer a product."""
        exponent = node.exp if node.exp.is_Rational else S.Zero
        if exponent == 0 or exponent.q > 2:
            return power, node.args
        whole = power_over(exponent.p) if self._boxes else product(exponent.p)
        if exponent.q == 1:
            return whole, (node.base,)
        rooted = root_over if self._boxes else root
        return (lambda base: whole(rooted(base))), (node.base,)

    def __call__(self, numbers: Numbers) -> Any:
        """The value for the numbers of all symbols."""
        return self.parts(numbers)[self._last]

    def parts(self, numbers: Numbers) -> list[Any]:
        """The values of all parts that are fixed, and None for others and for those not needed."""
        values: list[Any] = [None] * len(self._moves)
        for place, symbol in self._given:
            values[place] = ball(numbers[symbol])
        return _filled(values, self._steps[False])

    def function(self, numbers: Numbers) -> Function:
        """The value as a function of the symbol `along`; others have the given numbers."""
        known: dict[int, list[Any]] = {}
        at = self._number.get(self._along)

        def value(place: Ball) -> Any:
            if ctx.prec not in known:
                known[ctx.prec] = self.parts(numbers)
            values = known[ctx.prec].copy()
            if at is not None:
                values[at] = place
            return _filled(values, self._steps[True])[self._last]

        return value


def _filled(values: list[Any], steps: list[Step]) -> list[Any]:
    for place, computed in steps:
        values[place] = computed(values)
    return values


_OF_TWO: dict[type, Operation] = {Add: add, Mul: mul}
_CONSTANTS: dict[Basic, Operation] = {
    pi: arb.pi,
    Exp1(): arb.const_e,
    I: lambda: acb(0, 1),
    oo: lambda: arb("inf"),
    -oo: lambda: arb("-inf"),
    **dict.fromkeys((nan, zoo), lambda: arb("nan")),
}


@lru_cache(maxsize=5000)
def program(
    expr: Basic, along: Symbol | None = None, twice: bool = True, boxes: bool = False
) -> Program:
    """The steps of an expression."""
    return Program(expr, along, twice, boxes)


def _by_mpmath(node: Basic) -> Operation:
    """A function that python-flint does not have, by mpmath; its last digits are not trusted."""
    if isinstance(node, AppliedUndef | Boolean):
        raise Undecided(f"{node} cannot be computed numerically")
    held = sorted(node.free_symbols, key=str)
    function = lambdify(held, node, modules="mpmath", dummify=True)

    def operation(*values: Ball) -> Ball:
        with mpmath.workprec(ctx.prec + 20):
            found = ball(mpmath.mpmathify(function(*map(number, values))))
        return found + found * arb(0, arb(2) ** -ctx.prec)

    return operation


# ------------------------------------------------------------------ integrals


@cache
def _separated(over: Integral) -> tuple[Expr, Expr, tuple[Symbol, Expr, Expr], list[Symbol]]:
    """A constant factor, the integrand without it, its limits, and the symbols of both.

    SymPy writes nested integrals as one integral with several limits.
    """
    *inner, outer = over.limits
    inside = Integral(over.function, *inner) if inner else over.function
    factor, rest = inside.as_independent(outer[0], as_Add=False)
    return factor, rest, outer, sorted(Integral(rest, outer).free_symbols, key=str)


_KNOWN: dict[tuple[Any, ...], Ball | Undecided] = {}


def _integrated(over: Integral, numbers: Numbers, twice: bool) -> Ball:
    """The integral to the working digits of mpmath; remembered."""
    factor, inside, limits, held = _separated(over)
    key = (
        *(inside, *limits, mpmath.mp.dps, twice),
        *(number(part) for symbol in held for part in (numbers[symbol], numbers[symbol].rad())),
    )
    if key not in _KNOWN:
        try:
            _KNOWN[key] = _computed(inside, *limits, numbers, twice)
        except Undecided as error:
            _KNOWN[key] = error
    known = _KNOWN[key]
    if isinstance(known, Undecided):
        raise type(known)(str(known))
    return program(factor)(numbers) * known


def _computed(
    inside: Expr, variable: Symbol, low: Expr, high: Expr, numbers: Numbers, twice: bool
) -> Ball:
    working = mpmath.mp.dps
    with mpmath.workdps(3 * working), digits(4 * working):  # so that roots vanish at the ends
        start, end = (+number(program(each)(numbers)) for each in (low, high))
        if isinstance(start, mpc) or isinstance(end, mpc):
            raise Undecided("an end of an integral is not a real number")
        if start == end:
            return arb(0)
        sense, (start, end) = (1, (start, end)) if start < end else (-1, (end, start))
        cuts = _cuts(
            (start, end),
            (
                (zero, switch.kind)
                for switch in places(inside, variable)
                for zero in zeros_between(switch.of, variable, numbers, start, end)
            ),
        )
    integrand = program(inside, variable, twice).function(numbers)
    _demand_no_pole(integrand, cuts, variable)
    total = (checked if twice else integral)(integrand, list(cuts))
    if not total.is_finite():
        raise Undecided("the numerical integration does not converge")
    return sense * total


def _cuts(ends: tuple[mpf, mpf], known: Iterable[tuple[mpf, str]]) -> dict[mpf, set[str]]:
    """Both ends and all points between them, each with the kinds of what happens there.

    Points that agree to a third of the working digits are one.
    """
    start, end = ends
    close = (end - start) * mpf(10) ** (-mpmath.mp.dps // 3)
    cuts: dict[mpf, set[str]] = {start: set(), end: set()}
    for position, kind in known:
        if start - close <= position <= end + close:
            at = next((cut for cut in cuts if abs(cut - position) <= close), position)
            cuts.setdefault(at, set()).add(kind)
    return dict(sorted(cuts.items()))


def _demand_no_pole(along: Function, cuts: Mapping[mpf, set[str]], variable: Symbol) -> None:
    """Raise Undecided if the integrand grows like 1/distance, or faster, towards a cut."""
    for one, other in pairwise(cuts):
        for cut, length in ((one, other - one), (other, one - other)):
            if cuts[cut] and cuts[cut] <= _SMOOTH:
                continue
            with mpmath.workdps(40), digits(80):
                found = [along(ball(cut + part * length)) for part in _NEAR]
                if any(value.is_finite() and value.contains(0) for value in found):
                    continue
                far, near = (abs(number(value)) for value in found)
                grown = mpmath.log10(near / far) / mpmath.log10(_NEAR[0] / _NEAR[1])
            if not mpmath.isfinite(grown) or grown > _STEEPEST:
                raise Undecided(
                    f"the integral diverges: its integrand has a pole at {variable} = "
                    f"{mpmath.nstr(cut, 6)} "
                    "(write pv, or \\fint in LaTeX, if a principal value is meant)"
                )


# ------------------------------------------------------------------ points where to cut


def zeros_between(
    of: Expr, variable: Symbol, numbers: Numbers, start: mpf, end: mpf
) -> Iterator[mpf]:
    """Zeros between the ends: intervals without one are dropped, others are made smaller.

    Newton's step makes an interval smaller where the rate has one sign in it; else it is halved.
    Zeros of what contains an integral are not looked for.
    """
    if of.has(Integral):
        return
    slope = of.diff(variable)
    rates = nan if slope.has(Derivative, DiracDelta) else slope
    value, rate = (program(each, variable).function(numbers) for each in (of, rates))
    whole = arb(start).union(arb(end))
    enough = whole.rad() * arb(10) ** (-mpmath.mp.dps // 2)
    held = [whole]
    for _ in range(_LOOKED_AT):
        if not held:
            return
        within = held.pop()
        found = value(within)
        if found.is_finite() and not found.contains(0):
            continue
        middle, radius = within.mid(), within.rad()
        stepped = middle - value(middle) / rate(within)
        closer = stepped if isinstance(stepped, arb) and stepped.is_finite() else within
        if not within.overlaps(closer):
            continue
        if closer.rad() <= enough:
            yield number(closer)
        elif closer.rad() < radius / 4:
            held.append(closer)
        elif radius <= enough:
            yield number(middle)
        else:
            held += [arb(middle + side * radius / 2, radius / 2) for side in (-1, 1)]
