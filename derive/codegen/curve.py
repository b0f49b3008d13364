"""Prints a body whose integrals have no closed form: its curve and the functions that use it.

In:  a proven FormulaSheet.
Out: the text of `_curve`, which returns g', g'' and t g''' at a distance t from each break; the
     text of the law that integrates the curve.
     The method of integration is in runtime/pieces.py.

A break is a point at which one piece of the curve ends and the next begins.
"""

from collections.abc import Callable, Iterator, Sequence

from sympy import (
    Add,
    Expr,
    Function,
    Pow,
    S,
    Symbol,
    Tuple,
    cosh,
    cse,
    diff,
    expand,
    factor,
    numbered_symbols,
    powsimp,
    simplify,
    tanh,
)

from derive.body.piece import Piece
from derive.codegen.cuts import cuts_of
from derive.codegen.law import BREAKS, PRESSURE, SERIES, STATE, LawText, as_float
from derive.codegen.printer import NumPyPrinter
from derive.symbols import x

_t = Symbol("t", positive=True)
"""Distance from a break."""


class CurveText(LawText):
    """The text of the law of a body whose functions are integrated."""

    def _functions(self) -> Iterator[str]:
        """Code for the curve and for the functions that integrate it."""
        slope = self.sheet.geometry.slope
        positions, pieces = cuts_of(slope)
        functions = {
            "pressure": PRESSURE,
            "state": STATE,
            "slope": ("x", "g'(x) and g''(x); infinite beyond the ends of the body."),
            "series": SERIES,
        }
        yield "@kernel"
        words = "g', g'' and t g''' at the distance t from a break."
        lines = [*self._demands(), *_branches(pieces), "    return np.nan, np.nan, np.nan"]
        yield from self.function("_curve", "piece, side, t", words, lines)
        steps = {kink.position: kink.step for kink in slope.kinks}
        for name, words, values in (
            ("_cuts", "Points at which the curve is cut.", positions),
            ("_corners", "The jump of g' at each of these points.", map(steps.get, positions)),
        ):
            printed = (as_float(NumPyPrinter().doprint(value or S.Zero)) for value in values)
            yield "@kernel"
            yield from self.function(
                name, "", words, [f"    return np.array([{', '.join(printed)}])"]
            )
        for name, (arguments, words) in functions.items():
            lines = [
                *(self._ends() if name == "slope" else ()),
                "    curve = curve_of(_curve, _cuts, _corners)",
                f"    return pieces.{name}(curve, {arguments}, own)",
            ]
            yield from self.function(f"_law_{name}", arguments, words, lines)
        yield from self.function("_law_breaks", *BREAKS, ["    return _cuts(own)"])

    def _demands(self) -> Iterator[str]:
        """Code that returns NaN unless the parameters meet the conditions of the body.

        These are the conditions besides the positivity of the parameters.
        """
        for demand in self.sheet.geometry.slope.demands:
            yield f"    if not ({NumPyPrinter().doprint(demand)}):"
            yield "        return np.nan, np.nan, np.nan"

    def _ends(self) -> Iterator[str]:
        """Code for points beyond the ends of the body, if its curve has ends."""
        for end, side, slope in zip(
            self.sheet.geometry.slope.domain, ("<=", ">="), ("-np.inf", "np.inf"), strict=True
        ):
            if end.is_finite:
                yield f"    if x {side} {NumPyPrinter().doprint(end)}:"
                yield f"        return {slope}, np.inf"


def _branches(pieces: Sequence[Piece]) -> Iterator[str]:
    """Code for the curve next to each end of each piece."""
    for i, piece in enumerate(pieces):
        for sense, position in ((1, piece.lower), (-1, piece.upper)):
            if position.is_finite:
                yield f"    if piece == {i} and side == {sense}:"
                yield from _branch(piece, position, sense)


def _branch(piece: Piece, position: Expr, sense: int) -> Iterator[str]:
    """Code that returns g', g'' and t g''' at the distance t from a break."""

    def rates(expr: Expr) -> list[Expr]:
        return [sense * _rate(term) for term in Add.make_args(expr)]

    printer = NumPyPrinter({_t})
    position, named = _position(position, piece.slope)
    for symbol, value in named.items():
        yield f"        {symbol} = {printer.doprint(value)}"
    given = piece.slope.subs(x, position + sense * _t)
    slope = _shortest(simplify, Add.make_args(given))
    # factoring often gives a form of g'' without subtraction
    curvature = _shortest(lambda e: factor(simplify(e)), rates(slope), is_positive=True)
    change = _shortest(simplify, [_t * rate for rate in rates(curvature)])
    curves = [slope, curvature, change]
    steps, values = cse(curves, symbols=_named("s_", curves))
    printer = NumPyPrinter({_t, *(symbol for symbol, _ in steps)})
    for symbol, value in steps:
        yield f"        {symbol} = {printer.doprint(value)}"
    yield f"        return {', '.join(map(as_float, map(printer.doprint, values)))}"


def _position(position: Expr, slope: Expr) -> tuple[Expr, dict[Symbol, Expr]]:
    """A break as it enters the formulas: a symbol if its position contains a root.

    With roots of several parameters, the search for short forms would take minutes.

    >>> from sympy import sqrt, symbols
    >>> b, R = symbols("b R", positive=True)
    >>> _position(-b, x / R)
    (-b, {})
    >>> _position(-b / sqrt(b**2 + R**2), x / R)
    (-x_0, {x_0: b/sqrt(R**2 + b**2)})
    """
    if all(power.exp.is_Integer for power in position.atoms(Pow)):
        return position, {}
    sense = -1 if position.could_extract_minus_sign() else 1
    name = next(_named("x_", [position, slope])).name
    is_positive = (sense * position).is_positive
    symbol = Symbol(name, positive=True) if is_positive else Symbol(name, real=True)
    return sense * symbol, {symbol: sense * position}


class _tanh(Function):
    """A hyperbolic tangent whose derivative is not written as a difference."""

    nargs = 1

    def fdiff(self, _: int = 1) -> Expr:
        """1/cosh(z)**2, because 1 - tanh(z)**2 loses digits far from zero."""
        return cosh(self.args[0]) ** -2


def _rate(expr: Expr) -> Expr:
    """The derivative with respect to t.

    >>> from sympy import tanh
    >>> _rate(tanh(2 * _t))
    2/cosh(2*t)**2
    """
    return diff(expr.replace(tanh, _tanh), _t).replace(_tanh, tanh)


def _named(stem: str, beside: list[Expr]) -> Iterator[Symbol]:
    """Numbered symbols whose names do not occur in the expressions `beside`."""
    taken = [Symbol(symbol.name) for symbol in Tuple(*beside).free_symbols]
    return iter(numbered_symbols(stem, exclude=taken))


def _shortest(
    form: Callable[[Expr], Expr], terms: Sequence[Expr], is_positive: bool = False
) -> Expr:
    """The sum of the terms, with `form` applied to the sum or to each term, whichever is shorter.

    is_positive: allow the sum term by term only if no term is known to be negative or zero

    >>> _shortest(simplify, [1 / (1 + _t), 1 / (2 + _t)])
    1/(t + 2) + 1/(t + 1)
    """
    forms, whole = [form(term) for term in terms], form(Add(*terms))
    apart = Add(*map(_joined, forms))
    subtracts = is_positive and any(term.is_nonpositive for term in forms)
    return _joined(whole) if subtracts or whole.count_ops() <= apart.count_ops() else apart


def _joined(expr: Expr) -> Expr:
    """Join powers of t: t^k/t^2 becomes t^(k - 2), where k is a parameter or pi.

    Written separately, both powers may underflow to 0 at a small t, although their quotient does
    not.

    >>> from sympy import cosh, Symbol
    >>> k = Symbol("k", positive=True)
    >>> _joined(_t**k * (k * (k - 1) * cosh(_t) / _t**2 + 1))
    k*t**(k - 2)*(k - 1)*cosh(t) + t**k
    """
    powers = [power.exp for power in expr.atoms(Pow) if power.base == _t]
    if not (any(map(_is_uneven, powers)) and any(e.is_negative for e in powers)):
        return expr
    terms: dict[Expr, Expr] = {}
    for term in Add.make_args(expand(expr)):
        apart, with_t = powsimp(term).as_independent(_t, as_Add=False)
        terms[with_t] = terms.get(with_t, S.Zero) + apart
    return Add(*(factor(apart) * with_t for with_t, apart in terms.items()))


def _is_uneven(exponent: Expr) -> bool:
    """Whether an exponent is not known to be a multiple of one half, such as k, pi or 7/3."""
    return not (2 * exponent).is_integer
