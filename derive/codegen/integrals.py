"""Prints the functions of a body without closed formulas, and the integrals that they evaluate.

In:  a FormulaSheet and a Function of the contract.
Out: the text of the function; for its docstring, the integrals over g'' that
     generated/runtime/pieces.py evaluates, and the definitions of the functions in these integrals.

Each corner, where g' jumps, adds a term in which the jump of g' takes the place of g'' dxi.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache

from sympy import (
    Abs,
    Expr,
    Function,
    Integral,
    Max,
    Min,
    Piecewise,
    Rational,
    S,
    asinh,
    factor,
    pi,
    simplify,
    sqrt,
)

from derive.body.piece import Piece
from derive.body.profile import Kink, Slope
from derive.codegen.function import FunctionText, by_name, local
from derive.codegen.program import Program
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import E_star, P, a, c, h, x
from derive.theory.segments import root_ratio
from derive.theory.superposition import xi

slope, curvature, w, kernel = map(Function, ("g'", "g''", "w", "kernel"))
to_left, to_right = Function("r_left"), Function("r_right")

FinitePart = Function("FinitePart")

_IN_WORDS = (
    "FinitePart: the limit of the integral that ends at a distance d from the edge, without its "
    "term in 1/sqrt(d), as d goes to 0; next to the edge it is integrated by parts"
)


class IntegratedText(FunctionText):
    """The text of one function that is evaluated by quadrature."""

    note = "  Evaluated by quadrature."

    def _made(self) -> Program:
        """No program: no formula is rewritten, and the trial of the module tests the rest."""
        return Program({})

    @property
    def text(self) -> str:
        """The whole function, which passes its arguments on to the law of the body."""
        own = by_name(q.symbol for q in self.sheet.geometry.parameters)
        passed = ", ".join(map(str, (*self.function.arguments, *self.function.constants)))
        return f"{self._head}\n    return cycle.{self.function.name}(_BODY, {own}, {passed})"

    @property
    def _equations(self) -> Iterator[str]:
        """The integrals that are evaluated; a closed formula, if there is one, is on the sheet."""
        yield from lines_of(self.sheet, self.function.formulas)


def formula_of(profile: Slope, name: str) -> Expr:
    """The expression that is evaluated for a formula of the sheet.

    >>> from derive.body.library import load_geometry
    >>> formula_of(load_geometry("catenary").slope, "load")
    E_star*Integral(g''(xi)*w(xi), (xi, -a, c))/2
    """

    def pressed(weight: Callable[[Expr], Expr], of: Callable[[Expr], Expr] = S) -> Expr:
        """int g'' weight dxi, plus the terms of the corners."""
        curved = of(Integral(curvature(xi) * weight(xi), (xi, -a, c)))
        return curved + sum((k.step * weight(k.position) for k in _corners(profile)), S.Zero)

    if name == "tilt":
        return -Integral(slope(xi) / w(xi), (xi, -a, c)) / pi
    if name == "load":
        return E_star / 2 * pressed(w)
    if name == "moment":
        return (a - c) * P / 2 - E_star / 8 * pressed(lambda s: w(s) * (a - c + 2 * s))
    if name == "pressure":
        return E_star / pi * pressed(lambda s: kernel(x, s))
    ratio = to_left if name.endswith("left") else to_right
    if name.startswith("K_N"):
        return E_star / (pi * sqrt(h)) * pressed(ratio)
    finite = pressed(lambda s: ratio(s) * (3 + 2 * ratio(s) ** 2), FinitePart)
    return E_star / (6 * pi * h ** Rational(3, 2)) * finite


def lines_of(sheet: FormulaSheet, names: tuple[str, ...]) -> Iterator[str]:
    """The formulas as they are printed, and the definitions of the functions in them."""
    profile, own = sheet.geometry.slope, Function(local(sheet, "w"))  # a parameter may be named w
    formulas = {sheet[name].symbol: formula_of(profile, name) for name in names}
    if "moment" in names:
        formulas[P] = formula_of(profile, "load")
    used = {node.func for expr in formulas.values() for node in expr.atoms(Function)}
    defined = {f: d for f, d in definitions_of(profile).items() if f.func in used}
    for left, right in (formulas | defined).items():
        yield f"{text_of(left.replace(w, own))} = {text_of(right.replace(w, own))}"
    if FinitePart in used:
        yield _IN_WORDS


def _corners(profile: Slope) -> tuple[Kink, ...]:
    return tuple(k for k in profile.kinks if k.is_corner)


@lru_cache(maxsize=2)
def definitions_of(profile: Slope) -> Mapping[Expr, Expr]:
    """The definitions of the functions; they are zero at a corner outside the contact."""
    left, right = a + xi, c - xi
    ratios = (right / left, left / right)
    least = Min((a + x) * right, left * (c - x))
    to_edges = [sqrt(ratio) for ratio in ratios]
    if _corners(profile):
        to_edges = [root_ratio.definition(*ends) for ends in ((right, left), (left, right))]
        left, right, least = Max(0, left), Max(0, right), Max(0, least)
    return {
        w(xi): sqrt(left * right),
        to_left(xi): to_edges[0],
        to_right(xi): to_edges[1],
        kernel(x, xi): asinh(sqrt(least / (h * Abs(x - xi)))),
        slope(xi): _by_piece(profile, lambda piece: piece.slope),
        curvature(xi): _by_piece(profile, lambda piece: piece.curvature),
    }


def _by_piece(profile: Slope, of: Callable[[Piece], Expr]) -> Expr:
    *others, last = profile.pieces
    branches = [(_short(of(piece)), xi < piece.upper) for piece in others]
    return Piecewise(*branches, (_short(of(last)), True))


def _short(expr: Expr) -> Expr:
    """The expression at xi, factored unless that makes it longer."""
    simple = simplify(expr)
    return min(factor(simple), simple, key=lambda form: form.count_ops()).subs(x, xi)
