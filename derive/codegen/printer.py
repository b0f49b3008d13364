"""Prints SymPy expressions as NumPy source; an expression that it does not know is refused.

The printer also makes three changes:

* Half powers in a product are collected under one root.
* Factors that do not vary along the array are multiplied first, so that the array is traversed
  only once.
* A number that SymPy keeps exact is rounded once, as a whole.
"""

import ast
from collections.abc import Iterable
from math import isfinite

from sympy import (
    Add,
    And,
    Basic,
    Expr,
    Float,
    Function,
    Max,
    Min,
    Mul,
    NumberSymbol,
    Or,
    Piecewise,
    Pow,
    Rational,
    S,
    Symbol,
    oo,
)
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanFalse, BooleanTrue
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

from derive.theory.segments import FUNCTIONS as NAMED

_MUL = PRECEDENCE["Mul"]


class CannotPrint(Exception):
    """No NumPy code is known for an expression: a fault of the generator, not of the user."""


_SAME = ("cos", "cosh", "exp", "log", "sign", "sin", "sinh", "tan", "tanh")
_INVERSE = ("cos", "cosh", "sin", "sinh", "tan", "tan2", "tanh")
_FUNCTIONS = {name: f"np.{name}" for name in _SAME}
_FUNCTIONS |= {f"a{name}": f"np.arc{name}" for name in _INVERSE}
_FUNCTIONS["Abs"] = "np.abs"
_FUNCTIONS |= {function.__name__: function.__name__ for function in NAMED}
_NAMED = ("Max", "Min", "Piecewise")
_CONSTANTS = {S.Pi: "np.pi", S.Exp1: "np.e", S.EulerGamma: "np.euler_gamma"}

_NOT_EXACT = (Float, S.ImaginaryUnit, S.NaN, oo, -oo, S.ComplexInfinity)

_LARGEST_WHOLE = 2**53

_DIGITS = 40
"""Digits to which a number is evaluated before it is rounded to float64."""


_KNOWN = (
    *(Add, Mul, Pow, Symbol, Rational, NumberSymbol),
    *(Function, Max, Min, Piecewise, Relational, And, Or, BooleanTrue, BooleanFalse),
)


class NumPyPrinter(StrPrinter):
    """Prints expressions whose symbols are local variables."""

    def __init__(self, varying: Iterable[Symbol] = ()) -> None:
        super().__init__()
        self.varying = frozenset(varying)

    def _print(self, expr: Basic, **kwargs: object) -> str:
        if _is_rounded(expr):
            return _CONSTANTS.get(expr) or repr(_nearest(expr))
        name = type(expr).__name__
        unknown = isinstance(expr, Function) and name not in (*_FUNCTIONS, *_NAMED)
        if unknown or not isinstance(expr, _KNOWN) or isinstance(expr, Float):
            raise CannotPrint(
                f"no NumPy code is known for {type(expr).__name__}, which occurs in {expr}"
            )
        return str(super()._print(expr, **kwargs))

    def parenthesize(self, item: Basic, level: int, strict: bool = False) -> str:
        """Parenthesize as SymPy does, except that a root is a call and needs no parentheses."""
        if _is_rounded(item):
            inner = self._print(item)
            return inner if level <= PRECEDENCE["Add"] or inner[0] != "-" else f"({inner})"
        if item.is_Pow and item.exp == S.Half:
            return self._print(item)
        return super().parenthesize(item, level, strict)

    def _print_Function(self, expr: Expr) -> str:
        return f"{_FUNCTIONS[type(expr).__name__]}({', '.join(map(self._print, expr.args))})"

    _print_Abs = _print_sign = _print_log = _print_Function

    def _print_Add(self, expr: Add, order: object = None) -> str:
        """Print positive terms first: phi - alpha, not -alpha + phi."""
        terms = sorted(expr.as_ordered_terms(), key=lambda t: t.could_extract_minus_sign())
        first = terms[0]
        below = first.could_extract_minus_sign()  # if so, all terms are negative
        text = self._print(first) if below else self.parenthesize(first, PRECEDENCE["Add"])
        for term in terms[1:]:
            negative = term.could_extract_minus_sign()
            inner = self.parenthesize(-term if negative else term, PRECEDENCE["Add"])
            text += f" {'-' if negative else '+'} {inner}"
        return text

    def _print_Mul(self, expr: Mul) -> str:
        if expr.could_extract_minus_sign():
            return f"-{self.parenthesize(-expr, _MUL)}"
        factors = list(Mul.make_args(expr))
        fixed = [f for f in factors if not (f.free_symbols & self.varying or _is_root(f))]
        moving = [f for f in factors if f not in fixed]
        if len(fixed) < 2 or not _split(fixed)[0] or not moving:
            return self._quotient(factors)
        if not _split(moving)[0]:
            below = self._print(1 / Mul(*moving))
            return f"({self._quotient(fixed)}) / {below if _is_call(below) else f'({below})'}"
        return f"({self._quotient(fixed)}) * {self._quotient(moving)}"

    def _quotient(self, factors: list[Expr]) -> str:
        top, bottom = _split(factors)
        above = " * ".join(self.parenthesize(f, _MUL) for f in top) or "1"
        if not bottom:
            return above
        below = " * ".join(self.parenthesize(f, _MUL) for f in bottom)
        return f"{above} / ({below})" if len(bottom) > 1 else f"{above} / {below}"

    def _print_Pow(self, expr: Pow, rational: bool = False) -> str:
        base, exponent = expr.base, expr.exp
        if exponent == S.Half:
            return f"np.sqrt({self._print(base)})"
        if exponent.is_negative or _is_odd_half(exponent):
            return self._quotient([expr])
        if isinstance(base, Symbol) and exponent.is_Integer:
            return _product(self._print(base), int(exponent))
        below, above = (self.parenthesize(part, PRECEDENCE["Pow"]) for part in (base, exponent))
        return f"{below}**{above}"

    def _print_Integer(self, expr: Basic) -> str:
        """Print whole numbers of magnitude 2**53 or more as float64."""
        return str(expr) if abs(expr) < _LARGEST_WHOLE else repr(float(expr))

    def _print_Rational(self, expr: Rational) -> str:
        return f"{self._print(S(expr.p))} / {self._print(S(expr.q))}"

    def _print_Max(self, expr: Expr) -> str:
        name = "np.maximum" if isinstance(expr, Max) else "np.minimum"
        first, *rest = sorted(expr.args, key=lambda arg: (arg.is_number, str(arg)))
        text = self._print(first)
        for other in rest:
            text = f"{name}({text}, {self._print(other)}{'.0' * other.is_Integer})"
        return text

    _print_Min = _print_Max

    def _print_Piecewise(self, expr: Expr) -> str:
        *cases, (last, always) = expr.args
        if always is not S.true:
            raise CannotPrint(f"the last condition of a Piecewise must be True: {expr}")
        text = self._print(last)
        for value, condition in reversed(cases):
            text = f"where({self._print(condition)}, {self._print(value)}, {text})"
        return text

    def _print_Relational(self, expr: Basic) -> str:
        left, right = (self._print(side) for side in expr.args)
        return f"{left} {expr.rel_op} {right}"

    def _print_And(self, expr: Basic) -> str:
        sign = " & " if isinstance(expr, And) else " | "
        return sign.join(f"({self._print(arg)})" for arg in sorted(expr.args, key=str))

    _print_Or = _print_And


def _is_rounded(expr: Basic) -> bool:
    """Whether an expression is a number that is rounded as a whole, such as E or pi - 2.

    Quotients of whole numbers and their roots are excluded: NumPy rounds each of them only once.
    """
    if not isinstance(expr, NumberSymbol | Add | Pow | Function) or not expr.is_number:
        return False
    if expr.is_rational or expr.has(*_NOT_EXACT):
        return False
    return not (expr.is_Pow and abs(expr.exp) == S.Half)


def _nearest(number: Expr) -> float:
    """The float64 nearest to an exact number.

    Raises CannotPrint if that is zero or not finite.
    """
    value = number.evalf(_DIGITS, maxn=10 * _DIGITS)
    if not value.is_Float or not isfinite(float(value)) or float(value) == 0:
        raise CannotPrint(f"{number} has no finite, nonzero value in float64")
    return float(value)


def _is_call(text: str) -> bool:
    """Whether the text is a single call or name, which needs no parentheses."""
    return isinstance(ast.parse(text, mode="eval").body, ast.Call | ast.Name)


def _product(name: str, power: int) -> str:
    """A whole power written with squares, which NumPy computes many times faster."""
    if power <= 2:
        return f"{name}**{power}"
    if power % 2:
        return f"({name} * {_product(name, power - 1)})"
    return f"({_product(name, power // 2)})**2"


def _split(factors: list[Expr]) -> tuple[list[Expr], list[Expr]]:
    """Numerator and denominator; rationals are split, and half powers are collected in one root."""
    top: list[Expr] = []
    bottom: list[Expr] = []
    roots: tuple[list[Expr], list[Expr]] = ([], [])
    for f in factors:
        if f.is_Rational and not f.is_Integer:
            top += [S(f.p)] if f.p != 1 else []
            bottom.append(S(f.q))
        elif f.is_Pow and _is_odd_half(f.exp):
            half, sense = (abs(f.exp) - S.Half), (0 if f.exp > 0 else 1)
            roots[sense].append(f.base)
            (top, bottom)[sense].extend([f.base**half] if half else [])
        elif f.is_Pow and _is_below(f.exp):
            bottom.append(f.base**-f.exp)
        else:
            top.append(f)
    above, below = roots
    if above:
        top.append(_root(Mul(*above, *(1 / f for f in below))))
    elif below:
        bottom.append(_root(Mul(*below)))
    return top, bottom


def _is_root(factor: Expr) -> bool:
    return bool(factor.is_Pow and _is_odd_half(factor.exp))


def _is_below(exponent: Expr) -> bool:
    """Whether a power belongs in the denominator.

    The sign of its exponent decides, or its written form if the sign is not known: 1 - pi is
    negative although it is not written with a leading minus sign.
    """
    if exponent.is_negative is None:
        return bool(exponent.could_extract_minus_sign())
    return bool(exponent.is_negative)


def _is_odd_half(exponent: Expr) -> bool:
    """Whether an exponent is 1/2, -1/2, 3/2, ..."""
    return bool(exponent.is_Rational and exponent.q == 2)


def _root(inside: Expr) -> Expr:
    """sqrt(inside), not evaluated, because SymPy would split it again."""
    return Pow(inside, S.Half, evaluate=False)
