"""Finds the unit of each parameter from the condition that g(x) is a length.

The unit of each parameter is assumed to be a power of a metre, m**k.  Terms that are added or
compared, and the arguments of functions, give linear equations for the exponents k.  An exponent in
g(x) may contain a parameter.
"""

from collections.abc import Iterable, Mapping

from sympy import (
    Abs,
    Add,
    Dummy,
    Expr,
    Heaviside,
    Max,
    Min,
    Mul,
    Piecewise,
    Pow,
    S,
    Symbol,
    cos,
    exp,
    linsolve,
    sign,
    sin,
    tan,
)
from sympy.core.relational import Relational

from derive.command.errors import OpenUnits
from derive.reading.units import parse_unit
from derive.symbols import x


def units(g: Expr, given: Mapping[str, str]) -> dict[str, str]:
    """A unit for every parameter of g: the units that are given, and those that make g a length.

    Parameters whose units are not determined are assumed to be lengths, if that is consistent.  If
    no units are consistent, the result is refused later, when the dimensions are checked.

    Raises BadUnit, and OpenUnits if the units are not determined and cannot all be lengths.

    >>> from derive.symbols import x
    >>> R, phi = Symbol("R"), Symbol("phi")
    >>> units(x**2 / (2 * R) + phi * abs(x), {})
    {'R': 'm', 'phi': 'rad'}
    """
    known = {name: parse_unit(unit).length for name, unit in given.items()}
    parameters = sorted(g.free_symbols - {x}, key=str)
    unknown = {p: Dummy(p.name) for p in parameters if p.name not in known}
    powers = {x: S.One} | {p: unknown.get(p, known.get(p.name)) for p in parameters}
    solved = _solved(_equations(g, powers), unknown)
    texts = {p.name: _unit(p, power, g) for p, power in solved.items()}
    return {p.name: given.get(p.name) or texts[p.name] for p in parameters}


def _solved(equations: list[Expr], unknown: Mapping[Symbol, Symbol]) -> dict[Symbol, Expr]:
    """The power of a metre in the unit of each unknown parameter."""
    symbols = list(unknown.values())
    solution = next(iter(linsolve(equations, symbols)), None) if symbols else ()
    if solution is None:  # no units are consistent
        return dict.fromkeys(unknown, S.One)
    solved = dict(zip(unknown, solution, strict=True))
    lengths = dict.fromkeys(symbols, S.One)
    open_ = [p for p, power in solved.items() if power.has(*symbols)]
    if any(solved[p].subs(lengths) != 1 for p in open_):
        free = [p.name for p, symbol in unknown.items() if solved[p] == symbol]
        raise OpenUnits(tuple(p.name for p in open_), tuple(free))
    return solved | dict.fromkeys(open_, S.One)


def _equations(g: Expr, powers: Mapping[Symbol, Expr]) -> list[Expr]:
    """The expressions that must be zero for g to be a length."""
    walk = _Walk(powers)
    total = walk.power(g)
    return walk.zeros + ([] if total is None else [total - 1])


class _Walk:
    """The power of a metre in the unit of an expression, and the conditions for it to be one.

    `zeros` are the expressions that must be zero.  The rules are those of
    `derive.reading.units.dimension_of`.
    """

    def __init__(self, powers: Mapping[Symbol, Expr]) -> None:
        self.powers = powers
        self.zeros: list[Expr] = []

    def power(self, expr: Expr) -> Expr | None:
        """The power; None for a zero, which has every dimension."""
        if expr == 0:
            return None
        if isinstance(expr, Symbol):
            return self.powers[expr]
        if expr.is_number:
            return S.Zero
        if isinstance(expr, Mul):
            return sum((self._some(factor) for factor in expr.args), S.Zero)
        if isinstance(expr, Pow):
            return self._of_power(expr)
        if isinstance(expr, Add | Max | Min):
            return self._common(expr.args)
        if isinstance(expr, Abs):
            return self.power(expr.args[0])
        if isinstance(expr, Piecewise):
            for _, condition in expr.args:
                for relation in condition.atoms(Relational):
                    self._common(relation.args)
            return self._common(value for value, _ in expr.args)
        for argument in expr.args[:1]:
            power = self._some(argument)
            if not isinstance(expr, sign | Heaviside):
                self.zeros.append(power)
        return S.Zero

    def _some(self, expr: Expr) -> Expr:
        power = self.power(expr)
        return S.Zero if power is None else power

    def _of_power(self, expr: Pow) -> Expr:
        base = self._some(expr.base)
        self.zeros.append(self._some(expr.exp))
        if expr.exp.has(x):
            self.zeros.append(base)
            return S.Zero
        return base * expr.exp

    def _common(self, terms: Iterable[Expr]) -> Expr | None:
        powers = [power for term in terms if (power := self.power(term)) is not None]
        self.zeros += [power - powers[0] for power in powers[1:]]
        return powers[0] if powers else None


def _unit(parameter: Symbol, power: Expr, g: Expr) -> str:
    """m**power as text; the unit of a number is rad if it is a slope or an angle, otherwise -."""
    power = power.factor()
    if power == 0:
        return "rad" if _is_angle(parameter, g) else "-"
    if power.is_Rational and power < 0:
        return f"1/{_unit(parameter, -power, g)}"
    if power == 1:
        return "m"
    return f"m**{power}" if power.is_Integer else f"m**({power})"


def _is_angle(parameter: Symbol, g: Expr) -> bool:
    """Whether a parameter is a plain factor, or the argument of a trigonometric function.

    A parameter that occurs in an exponent is not an angle.
    """
    if any(node.exp.has(parameter) for node in g.atoms(Pow, exp)):
        return False
    return any(parameter in node.args for node in g.atoms(Mul, sin, cos, tan))
