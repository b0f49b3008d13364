"""Units: read, checked in every formula, and found where they are not stated.

All quantities of the half-plane are products of powers of a pressure and a length.  A dimension is
therefore a pair of exponents.  An exponent may contain a parameter, as in C |x|**n, and unknowns.

    parse_unit        the text of a unit -> its dimension
    dimension_of      a formula and the dimensions of its symbols -> its dimension
    units_of_profile  g(x) -> the units of its parameters that make it a length
    Units             printed equations, one after another -> the term that does not fit
"""

from collections.abc import Iterable, Mapping
from copy import copy
from dataclasses import dataclass
from functools import reduce

import sympy
from sympy import Dummy, Expr, Integral, Pow, S, Symbol, expand
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from derive.command.errors import BadText, BadUnit, DimensionMismatch, OpenUnits
from derive.reading.improper import IMPROPER, as_integral
from derive.reading.text import parse
from derive.reading.value import Meaning
from derive.reading.words import FUNCTIONS, Words
from derive.symbols import x

_PRESSURE, _LENGTH = Symbol("Pa", positive=True), Symbol("m", positive=True)


@dataclass(frozen=True)
class Dimension:
    """Pa**pressure * m**length."""

    pressure: Expr = S.Zero
    length: Expr = S.Zero

    def __mul__(self, other: "Dimension") -> "Dimension":
        return Dimension(self.pressure + other.pressure, self.length + other.length)

    def __pow__(self, exponent: Expr) -> "Dimension":
        return Dimension(self.pressure * exponent, self.length * exponent)

    @property
    def is_known(self) -> bool:
        """Whether neither exponent contains an unknown."""
        return not (self.pressure.has(Dummy) or self.length.has(Dummy))

    def __str__(self) -> str:
        return str(_PRESSURE**self.pressure * _LENGTH**self.length)


# ------------------------------------------------------------------ units as text


NUMBER = Dimension()
_UNITS = {"Pa": _PRESSURE, "m": _LENGTH, "N": _PRESSURE * _LENGTH**2, "rad": S.One}
_WORDS = Words({"sqrt": FUNCTIONS["sqrt"]}, deepest=20)


def parse_unit(text: str) -> Dimension:
    """Read a unit such as 'm', 'N/m', 'Pa/sqrt(m)', 'm**(1 - n)', '-'.

    Raises BadUnit for anything else.
    """
    if not isinstance(text, str):
        raise BadUnit(repr(text), "it is not a string")
    if text.strip() in ("-", ""):
        return NUMBER
    try:
        tree = parse(text, _WORDS)
        names = {name: Symbol(name, positive=True) for name in tree.names()}
        powers = Meaning(tree, names | _UNITS).value(tree.root).as_powers_dict()
    except BadText:
        raise BadUnit(repr(text), "it is not a product of powers") from None
    exponents = set().union(*(exponent.free_symbols for exponent in powers.values()))
    unknown = {*powers} - {S.One, _PRESSURE, _LENGTH} | exponents & {_PRESSURE, _LENGTH}
    if unknown or "." in text:
        other = ", ".join(sorted(map(str, unknown))) or "a decimal number"
        raise BadUnit(repr(text), f"{other!r} is not a known unit")
    return Dimension(powers[_PRESSURE], powers[_LENGTH])


# ------------------------------------------------------------------ the dimension of a formula

Call = tuple[tuple[Dimension, ...], Dimension]
"""The units of the arguments of a formula, and the unit of its value."""


class Units:
    """The units of symbols: those that are known, and those that equations have shown.

    A symbol whose unit is unknown may have any unit, but the same one everywhere: each equation
    that is consistent adds to what is known about it.

    known    units of symbols
    meaning  meanings of symbols, which are taken into account when a symbol first occurs
    calls    units of the arguments and of the values of formulas that are called
    """

    def __init__(
        self,
        known: Mapping[Symbol, Dimension],
        meaning: Mapping[Symbol, Expr] | None = None,
        calls: Mapping[str, Call] | None = None,
    ) -> None:
        # Their changes are made in new mappings, so that a copy of this object is a trial.
        self.known, self.meaning, self.calls = known, meaning or {}, calls or {}
        self.solved: Mapping[Dummy, Expr] = {}

    def mismatch(self, left: Expr, right: Expr) -> str:
        """Describe the units that do not fit in an equation; empty if they may all fit."""
        trial = copy(self)
        try:
            trial.common((left, right))
        except DimensionMismatch as wrong:
            return f"the unit of {wrong.where} is {wrong.found}, but must be {wrong.expected}"
        vars(self).update(vars(trial))
        return ""

    def unit_of(self, expr: Expr) -> str:
        """Return the unit of an expression as text, or an empty string if it is not known."""
        trial = copy(self)
        try:
            unit = trial._shown(trial.of(expr) or NUMBER)
        except DimensionMismatch:
            return ""
        return "" if "?" in unit else unit

    def of(self, expr: Expr) -> Dimension | None:
        """The dimension of an expression; None for zero, which has every dimension."""
        if expr == 0:
            return None
        if isinstance(expr, Symbol):
            return self._of_symbol(expr)
        if expr.is_number:
            return NUMBER
        if isinstance(expr, sympy.Mul):
            return reduce(Dimension.__mul__, (self.of(factor) or NUMBER for factor in expr.args))
        if isinstance(expr, Pow):
            return self._of_power(expr)
        if isinstance(expr, sympy.Add | sympy.Max | sympy.Min):
            return self.common(expr.args, expr)
        if isinstance(expr, sympy.Abs | sympy.Limit | sympy.UnevaluatedExpr):
            return self.of(expr.args[0])
        if isinstance(expr, sympy.Piecewise):
            for relation in (r for _, condition in expr.args for r in condition.atoms(Relational)):
                self.common(relation.args, relation)
            return self.common([value for value, _ in expr.args], expr)
        if isinstance(expr, (Integral, *IMPROPER)):
            return self._of_integral(as_integral(expr))
        if isinstance(expr, sympy.Derivative):
            below = [self._of_symbol(along) ** -times for along, times in expr.variable_count]
            return reduce(Dimension.__mul__, below, self.of(expr.expr) or NUMBER)
        if isinstance(expr, AppliedUndef):
            return self._of_call(expr)
        if isinstance(expr, sympy.sign | sympy.Heaviside):
            self.of(expr.args[0])
        elif isinstance(expr, sympy.atan2) or getattr(expr, "of_a_quotient", False):
            self.common(expr.args, expr)
        else:
            is_hyper = isinstance(expr, sympy.hyper)
            for each in (*expr.ap, *expr.bq, expr.argument) if is_hyper else expr.args:
                self._demand_number(each, f"the argument {each} of {expr.func}")
        return NUMBER

    def common(self, terms: Iterable[Expr], whole: sympy.Basic | None = None) -> Dimension | None:
        """The dimension that all terms of an expression have."""
        common, first = None, S.Zero
        inside = "" if whole is None else f" in {whole}"
        for term in terms:
            found = self.of(term)
            if common is None:
                common, first = found, term
            elif found is not None:
                self.equate(found, common, f"{term}{inside}", str(first))
        return common

    def equate(self, found: Dimension, wanted: Dimension, where: str, beside: str = "") -> None:
        """Solve for an unknown power, so that two dimensions agree.

        Raises DimensionMismatch; `where` is what has the first, and `beside` what has the second.
        """
        for gap in (found.pressure - wanted.pressure, found.length - wanted.length):
            left = expand(expand(gap).xreplace(self.solved))
            if unknown := sorted(left.atoms(Dummy), key=lambda power: power.dummy_index):
                numeric = [power for power in unknown if left.coeff(power).is_number]
                first = (numeric or unknown)[0]
                value = expand(-left.xreplace({first: S.Zero}) / left.coeff(first))
                table = {first: value}
                self.solved = {d: expand(v.xreplace(table)) for d, v in self.solved.items()} | table
            elif left != 0 and left.equals(0) is False:
                raise self._misfit(found, wanted, where, beside)

    def _demand_number(self, expr: Expr, where: str) -> None:
        if (found := self.of(expr)) is not None:
            self.equate(found, NUMBER, where)

    def _of_power(self, expr: Pow) -> Dimension:
        self._demand_number(expr.exp, f"the exponent of {expr}")
        base = self.of(expr.base) or NUMBER
        if expr.exp.has(x) and not base.is_known:
            self.equate(base, NUMBER, f"the base of {expr}")
            return NUMBER
        return base**expr.exp

    def _of_symbol(self, symbol: Symbol) -> Dimension:
        own = None
        if symbol in self.meaning:
            meaning = self.meaning[symbol]
            self.meaning = {s: other for s, other in self.meaning.items() if s != symbol}
            own = self.of(meaning)
        if symbol not in self.known:
            unknown = Dimension(Dummy(symbol.name), Dummy(symbol.name))
            self.known = {**self.known, symbol: own or unknown}
        elif own is not None:
            what = f"the meaning {meaning} of {symbol}"
            self.equate(own, self.known[symbol], what, "its declaration")
        return self.known[symbol]

    def _of_call(self, expr: Expr) -> Dimension:
        takes, value = self.calls[expr.func.__name__]
        for argument, wanted in zip(expr.args, takes, strict=True):
            if (found := self.of(argument)) is not None:
                self.equate(found, wanted, f"the argument {argument} of {expr.func}")
        return value

    def _of_integral(self, expr: Integral) -> Dimension:
        total, outside = NUMBER, self.known
        for variable, *ends in reversed(expr.limits):
            along = self.common([end for end in ends if end != S.Infinity], expr)
            if along is None:  # the ends are zero or infinity
                along = self._of_symbol(variable) if ends else NUMBER
            self.known = {**self.known, variable: along}
            total = total * along
        total = total * (self.of(expr.function) or NUMBER)
        bound = {variable for variable, *_ in expr.limits}
        inside = {symbol: unit for symbol, unit in self.known.items() if symbol not in bound}
        self.known = {**outside, **inside}
        return total

    def _misfit(
        self, found: Dimension, wanted: Dimension, where: str, beside: str
    ) -> DimensionMismatch:
        """A misfit, with the units as far as they are known."""
        has, needs = self._shown(found), self._shown(wanted)
        if beside and "?" in has + needs:
            ratio = self._shown(found * wanted**S.NegativeOne)
            return DimensionMismatch(f"{where} over {beside}", ratio, "1")
        return DimensionMismatch(where, has, f"{needs}, as that of {beside}" if beside else needs)

    def _shown(self, unit: Dimension) -> str:
        powers = [expand(power).xreplace(self.solved) for power in (unit.pressure, unit.length)]
        shown = Dimension(*powers)
        return str(shown) if shown.is_known else "?"


def dimension_of(expr: Expr, dimensions: Mapping[Symbol, Dimension]) -> Dimension | None:
    """Dimension of `expr`; None for zero, which has every dimension.

    Raises DimensionMismatch if the terms of a sum differ, or if the argument of a function or an
    exponent is not a pure number.
    """
    expr = sympy.sympify(expr, strict=True)
    assert expr.free_symbols <= dimensions.keys(), expr
    return Units(dimensions).of(expr)


def check(expr: Expr, unit: str, where: str, dimensions: Mapping[Symbol, Dimension]) -> None:
    """Raise DimensionMismatch unless `expr` has the dimension of `unit`."""
    if (found := dimension_of(expr, dimensions)) is not None:
        Units(dimensions).equate(found, parse_unit(unit), where)


# ------------------------------------------------------------------ the parameters of g(x)


def units_of_profile(g: Expr, given: Mapping[str, str]) -> dict[str, str]:
    """A unit for every parameter of g: the units that are given, and those that make g a length.

    Each of these is a power of a metre.  Parameters whose units are not determined are assumed to
    be lengths, if that is consistent.  If no units are consistent, the result is refused later,
    when the dimensions are checked.

    Raises BadUnit, and OpenUnits if the units are not determined and cannot all be lengths.

    >>> R, phi = Symbol("R"), Symbol("phi")
    >>> units_of_profile(x**2 / (2 * R) + phi * abs(x), {})
    {'R': 'm', 'phi': 'rad'}
    """
    parameters = sorted(g.free_symbols - {x}, key=str)
    powers = {p: parse_unit(given[p.name]).length for p in parameters if p.name in given}
    unknown = {p: Dummy(p.name) for p in parameters if p not in powers}
    length = Dimension(length=S.One)
    units = Units(
        {p: Dimension(length=power) for p, power in ({x: S.One} | powers | unknown).items()}
    )
    try:
        units.equate(units.of(g) or length, length, "g")
    except DimensionMismatch:
        units.solved = dict.fromkeys(unknown.values(), S.One)
    solved = {p: units.solved.get(power, power) for p, power in unknown.items()}
    open_ = [p for p, power in solved.items() if power.has(Dummy)]
    lengths = dict.fromkeys(unknown.values(), S.One)
    if any(solved[p].xreplace(lengths) != 1 for p in open_):
        free = [f"--unit {p.name}=m" for p, power in unknown.items() if solved[p] == power]
        raise OpenUnits(tuple(p.name for p in open_), " ".join(free))
    solved |= dict.fromkeys(open_, S.One)
    return {p.name: given.get(p.name) or _power_of_metre(p, solved[p], g) for p in parameters}


def _power_of_metre(parameter: Symbol, power: Expr, g: Expr) -> str:
    """m**power as text; the unit of a number is rad if it is a slope or an angle, otherwise -."""
    if power == 0:
        return "rad" if _is_angle(parameter, g) else "-"
    return str(_LENGTH ** power.factor())


def _is_angle(parameter: Symbol, g: Expr) -> bool:
    """Whether a parameter is a plain factor, or the argument of a trigonometric function.

    A parameter that occurs in an exponent is not an angle.
    """
    if any(node.exp.has(parameter) for node in g.atoms(Pow, sympy.exp)):
        return False
    return any(
        parameter in node.args for node in g.atoms(sympy.Mul, sympy.sin, sympy.cos, sympy.tan)
    )
