"""Check the units of printed equations and name the term that does not fit.

Units are taken from the body's formula sheet and from the entries `unit = ...` of variables and
symbols.  A symbol without a declared unit may have any unit, but the same one in all claims:
every equation that is consistent adds information about it.
"""

from collections.abc import Callable, Mapping
from functools import reduce

from sympy import (
    Abs,
    Add,
    Derivative,
    Dummy,
    Expr,
    Heaviside,
    Integral,
    Limit,
    Max,
    Min,
    Mul,
    Piecewise,
    Pow,
    Symbol,
    atan2,
    expand,
    sign,
)
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from derive.reading.improper import IMPROPER
from derive.reading.units import NUMBER, Dimension

Call = tuple[tuple[Dimension, ...], Dimension]
"""The units of the arguments of a formula, and the unit of its value."""


def ordinary(expr: Expr) -> Expr:
    """Write principal values and integrals to infinity as integrals, for units and symbols."""
    return expr.replace(lambda node: isinstance(node, IMPROPER), _between)


def _between(improper: Expr) -> Integral:
    inside, along, low, *high = improper.args
    return Integral(inside, (along, low, *(high or [low])))


class _Mismatch(Exception):
    """Two units that should be equal differ."""


class Units:
    """The known units of a claims file.

    known    units of variables, and of symbols with a declared unit
    meaning  meanings of symbols, as written in the file
    calls    units of the body's formulas and of their arguments
    """

    def __init__(
        self,
        known: Mapping[Symbol, Dimension],
        meaning: Mapping[Symbol, Expr],
        calls: Mapping[str, Call],
    ) -> None:
        self.known, self.meaning, self.calls = dict(known), meaning, calls
        self.solved: dict[Dummy, Expr] = {}
        self._seen: set[Symbol] = set()

    def mismatch(self, left: Expr, right: Expr) -> str:
        """Describe the units that do not fit in an equation; empty if they may all fit."""
        before = dict(self.known), dict(self.solved), set(self._seen)
        try:
            self._same(left, right, "")
        except _Mismatch as error:
            self.known, self.solved, self._seen = before
            return str(error)
        return ""

    def unit_of(self, symbol: Symbol) -> str:
        """Return the unit of a symbol as text, or an empty string if it is not known."""
        before = dict(self.known), dict(self.solved), set(self._seen)
        try:
            unit = self._shown(self._of_symbol(symbol))
        except _Mismatch:
            unit = ""
        self.known, self.solved, self._seen = before
        return "" if "?" in unit else unit

    def _same(self, one: Expr, other: Expr, whole: str) -> Dimension | None:
        """Return the common unit of two terms."""
        first, second = self._of(one), self._of(other)
        if first is None or second is None:
            return first or second
        inside = f" in {whole}" if whole else ""
        self._equate(first, second, f"{other}", f"{one}{inside}")
        return first

    def _equate(self, first: Dimension, second: Dimension, what: str, beside: str) -> None:
        gaps = (second.pressure - first.pressure, second.length - first.length)
        for gap in gaps:
            left = expand(expand(gap).xreplace(self.solved))
            unknown = sorted(left.atoms(Dummy), key=lambda d: d.dummy_index)
            free = [d for d in unknown if left.coeff(d).is_number and left.coeff(d) != 0]
            if free:
                value = expand(-left.xreplace({free[0]: 0}) / left.coeff(free[0]))
                table = {free[0]: value}
                self.solved = {d: expand(v.xreplace(table)) for d, v in self.solved.items()}
                self.solved[free[0]] = value
            elif not unknown and left.equals(0) is False:
                one, other = self._shown(first), self._shown(second)
                if "?" in one + other:
                    by = self._shown(Dimension(*gaps))
                    raise _Mismatch(f"the unit of {what} is {by} times that of {beside}")
                raise _Mismatch(f"{what} is in {other}, but {beside} is in {one}")

    def _shown(self, unit: Dimension) -> str:
        powers = [expand(e).xreplace(self.solved) for e in (unit.pressure, unit.length)]
        if any(power.has(Dummy) for power in powers):
            return "?"
        return str(Dimension(*powers))

    def _number(self, expr: Expr, where: str) -> None:
        """Raise _Mismatch if an expression that must be dimensionless is not."""
        unit = self._of(expr)
        if unit is not None:
            try:
                self._equate(NUMBER, unit, str(expr), where)
            except _Mismatch:
                shown = self._shown(unit)
                raise _Mismatch(f"{expr} is in {shown}, but {where} must be a number") from None

    def _of(self, expr: Expr) -> Dimension | None:
        """Return the unit of an expression, or None for zero, which fits every unit."""
        if expr == 0:
            return None
        if isinstance(expr, Symbol):
            return self._of_symbol(expr)
        if expr.is_number:
            return NUMBER
        if isinstance(expr, Mul):
            return reduce(Dimension.__mul__, (self._of(each) or NUMBER for each in expr.args))
        if isinstance(expr, Pow):
            self._number(expr.exp, f"the exponent of {expr}")
            if not expr.exp.is_number and expr.base.is_number:
                return NUMBER
            return (self._of(expr.base) or NUMBER) ** expr.exp
        if isinstance(expr, Add | Max | Min):
            return self._common(expr.args, expr)
        for kinds, read in self._readers:
            if isinstance(expr, kinds):
                return read(self, expr)
        for argument in expr.args:
            self._number(argument, f"the argument of {expr.func}")
        return NUMBER

    def _of_symbol(self, symbol: Symbol) -> Dimension:
        if symbol not in self.known:
            own = self._of(self.meaning[symbol]) if symbol in self.meaning else None
            self.known[symbol] = own or Dimension(Dummy(symbol.name), Dummy(symbol.name))
        elif symbol in self.meaning and symbol not in self._seen:
            self._seen.add(symbol)
            own = self._of(self.meaning[symbol])
            if own is not None:
                what = f"the meaning {self.meaning[symbol]} of {symbol}"
                self._equate(self.known[symbol], own, what, f"{symbol} as declared")
        return self.known[symbol]

    def _common(self, terms: tuple[Expr, ...], whole: Expr) -> Dimension | None:
        common, first = None, terms[0]
        for term in terms:
            unit = self._of(term)
            if common is None:
                common, first = unit, term
            elif unit is not None:
                self._equate(common, unit, str(term), f"{first} in {whole}")
        return common

    def _of_call(self, expr: Expr) -> Dimension:
        wanted, own = self.calls[expr.func.__name__]
        for argument, unit in zip(expr.args, wanted, strict=True):
            given = self._of(argument)
            if given is not None:
                self._equate(unit, given, str(argument), f"this argument of {expr.func}")
        return own

    def _of_integral(self, expr: Integral) -> Dimension:
        total, before = NUMBER, dict(self.known)
        for variable, *ends in expr.limits:
            along = self._common(tuple(ends), expr)
            if along is not None:
                self.known[variable] = along
            total = total * self._of_symbol(variable)
        total = total * (self._of(expr.function) or NUMBER)
        for variable, *_ in expr.limits:
            self.known.pop(variable, None)
            if variable in before:
                self.known[variable] = before[variable]
        return total

    def _of_derivative(self, expr: Derivative) -> Dimension:
        unit = self._of(expr.expr) or NUMBER
        for variable, times in expr.variable_count:
            unit = unit * self._of_symbol(variable) ** (-times)
        return unit

    def _of_cases(self, expr: Piecewise) -> Dimension | None:
        for _, condition in expr.args:
            for relation in condition.atoms(Relational):
                self._same(relation.lhs, relation.rhs, str(relation))
        return self._common(tuple(value for value, _ in expr.args), expr)

    def _of_pair(self, expr: Expr) -> Dimension:
        self._common(expr.args[:2] if isinstance(expr, atan2) else expr.args[:1], expr)
        return NUMBER

    _readers: tuple[tuple[tuple[type, ...], Callable[["Units", Expr], Dimension | None]], ...] = (
        ((AppliedUndef,), _of_call),
        ((*IMPROPER,), lambda units, expr: units._of_integral(_between(expr))),
        ((Abs, Limit), lambda units, expr: units._of(expr.args[0])),
        ((Integral,), _of_integral),
        ((Derivative,), _of_derivative),
        ((Piecewise,), _of_cases),
        ((atan2, sign, Heaviside), _of_pair),
    )
