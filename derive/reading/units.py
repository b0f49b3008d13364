"""Units and dimensions: every formula is checked as soon as it is made.

All quantities of the half-plane are products of powers of a pressure and a length.  A dimension is
therefore a pair of exponents.  An exponent may contain a parameter, as in C |x|**n.
"""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import reduce

from sympy import (
    Abs,
    Add,
    Basic,
    Expr,
    Function,
    Heaviside,
    Integer,
    Integral,
    Max,
    Min,
    Mul,
    Piecewise,
    Pow,
    Rational,
    S,
    Symbol,
    UnevaluatedExpr,
    atan2,
    hyper,
    sign,
    simplify,
    sympify,
)
from sympy.core.relational import Relational

from derive.command.errors import BadText, BadUnit, DimensionMismatch
from derive.reading.tree import parse
from derive.reading.words import FUNCTIONS, Words


@dataclass(frozen=True)
class Dimension:
    """Pa**pressure * m**length."""

    pressure: Expr = S.Zero
    length: Expr = S.Zero

    def __mul__(self, other: "Dimension") -> "Dimension":
        return Dimension(self.pressure + other.pressure, self.length + other.length)

    def __pow__(self, exponent: Expr) -> "Dimension":
        return Dimension(self.pressure * exponent, self.length * exponent)

    def agrees(self, other: "Dimension") -> bool:
        """Whether both are the same dimension."""
        return bool(
            simplify(self.pressure - other.pressure) == 0
            and simplify(self.length - other.length) == 0
        )

    def __str__(self) -> str:
        factors = [
            name if power == 1 else f"{name}**{_in_parentheses(power)}"
            for name, power in (("Pa", self.pressure), ("m", self.length))
            if power != 0
        ]
        return " ".join(factors) or "1"


def _in_parentheses(power: Expr) -> str:
    return str(power) if power.is_Integer and power > 0 else f"({power})"


NUMBER = Dimension()
_UNITS = {
    "m": Dimension(length=S.One),
    "Pa": Dimension(pressure=S.One),
    "N": Dimension(pressure=S.One, length=Integer(2)),
    "rad": NUMBER,
}
_WORDS = Words({"sqrt": FUNCTIONS["sqrt"]}, deepest=20)


def parse_unit(text: str) -> Dimension:
    """Read a unit such as 'm', 'N/m', 'Pa/sqrt(m)', 'm**(1 - n)', '-'.

    Raises BadUnit for anything else.
    """
    if not isinstance(text, str):
        raise BadUnit(text, "it is not a string")
    if text.strip() in ("-", "1", ""):
        return NUMBER
    try:
        return _unit(parse(text, _WORDS).root, text)
    except BadText:
        raise BadUnit(text, "it is not a product of powers") from None


def _unit(node: ast.expr, text: str) -> Dimension:
    match node:
        case ast.Name(id=name) if name in _UNITS:
            return _UNITS[name]
        case ast.Constant(value=int(number)) if number == 1 and number is not True:
            return NUMBER
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return _unit(left, text) * _unit(right, text)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return _unit(left, text) * _unit(right, text) ** Integer(-1)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return _unit(left, text) ** _exponent(right, text)
        case ast.Call(func=ast.Name(id="sqrt"), args=[inside], keywords=[]):
            return _unit(inside, text) ** Rational(1, 2)
    raise BadUnit(text, f"{ast.unparse(node)!r} is not a known unit")


def _exponent(node: ast.expr, text: str) -> Expr:
    match node:
        case ast.Constant(value=int(number)):
            return Integer(number)
        case ast.Name(id=name):
            return Symbol(name, positive=True)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_exponent(operand, text)
        case ast.BinOp(left=left, op=operation, right=right):
            first, second = _exponent(left, text), _exponent(right, text)
            match operation:
                case ast.Add():
                    return first + second
                case ast.Sub():
                    return first - second
                case ast.Mult():
                    return first * second
                case ast.Div() if second != 0:
                    return first / second
    raise BadUnit(text, f"{ast.unparse(node)!r} is not an exponent")


def dimension_of(expr: Expr, dimensions: Mapping[Symbol, Dimension]) -> Dimension | None:
    """Dimension of `expr`; None for zero, which has every dimension.

    Raises DimensionMismatch if the terms of a sum differ, or if the argument of a function or an
    exponent is not a pure number.
    """
    expr = sympify(expr, strict=True)
    if expr == 0:
        return None
    if isinstance(expr, Symbol):
        return dimensions[expr]
    if expr.is_number:
        return NUMBER
    if isinstance(expr, Mul):
        factors = [dimension_of(factor, dimensions) or NUMBER for factor in expr.args]
        return reduce(Dimension.__mul__, factors)
    if isinstance(expr, Pow):
        _demand(expr.exp, NUMBER, f"the exponent of {expr}", dimensions)
        base = dimension_of(expr.base, dimensions) or NUMBER
        return base**expr.exp
    if isinstance(expr, Add | Max | Min) or getattr(expr, "of_one_dimension", False):
        return _common(expr.args, expr, dimensions)
    if isinstance(expr, Abs | UnevaluatedExpr):
        return dimension_of(expr.args[0], dimensions)
    if getattr(expr, "of_a_quotient", False):
        _common(expr.args, expr, dimensions)
        return NUMBER
    if isinstance(expr, atan2 | sign | Heaviside):
        _common(expr.args[:2] if isinstance(expr, atan2) else expr.args[:1], expr, dimensions)
        return NUMBER
    if isinstance(expr, Piecewise):
        for _, condition in expr.args:
            for relation in condition.atoms(Relational):
                _common((relation.lhs, relation.rhs), relation, dimensions)
        return _common([value for value, _ in expr.args], expr, dimensions)
    if isinstance(expr, Integral):
        integrand, (variable, *ends) = expr.function, expr.limits[0]
        along = _common(ends, expr, dimensions) or NUMBER
        inside = dimension_of(integrand, {**dimensions, variable: along}) or NUMBER
        return inside * along
    if isinstance(expr, Function):
        arguments = (*expr.ap, *expr.bq, expr.argument) if isinstance(expr, hyper) else expr.args
        for argument in arguments:
            _demand(argument, NUMBER, f"the argument {argument} of {expr.func}", dimensions)
        return NUMBER
    raise DimensionMismatch(str(expr), "unknown", "known")


def _common(
    terms: Iterable[Expr], whole: Basic, dimensions: Mapping[Symbol, Dimension]
) -> Dimension | None:
    found: Dimension | None = None
    for term in terms:
        dimension = dimension_of(term, dimensions)
        if found is None:
            found = dimension
        elif dimension is not None and not found.agrees(dimension):
            raise DimensionMismatch(f"{term} in {whole}", str(dimension), str(found))
    return found


def _demand(
    expr: Expr, wanted: Dimension, where: str, dimensions: Mapping[Symbol, Dimension]
) -> None:
    found = dimension_of(expr, dimensions)
    if found is not None and not found.agrees(wanted):
        raise DimensionMismatch(where, str(found), str(wanted))


def check(expr: Expr, unit: str, where: str, dimensions: Mapping[Symbol, Dimension]) -> None:
    """Raise DimensionMismatch unless `expr` has the dimension of `unit`."""
    _demand(expr, parse_unit(unit), where, dimensions)
