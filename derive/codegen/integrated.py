"""Functions of a body whose integrals have no closed form: its curve, and quadrature of it.

In:  a proven FormulaSheet.
Out: the text of the body's `Profile`, piece by piece, and of the functions that integrate it.  The
     method is support/_quadrature.py.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from sympy import (
    Add,
    Expr,
    Function,
    Poly,
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
    sqrt,
    tanh,
)

from derive.codegen.cancel import cancels, cuts_of, plain_cuts, size_of_terms, terms_of
from derive.codegen.decay import decaying
from derive.codegen.function import CallingText, FunctionText, local, own_parameters
from derive.codegen.memory import LABORIOUS
from derive.codegen.printer import NumPyPrinter
from derive.codegen.rise import from_zero
from derive.piece import Piece
from derive.profile import Slope, has_sharp_power
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c, x

Steps = list[tuple[Symbol, Expr]]

_t = Symbol("t", positive=True)
"""Distance from a break."""

_RETURNED = {
    "tilt": "now.tilt",
    "load": "E_star * now.load",
    "moment": "E_star * now.moment",
    "K_N": "E_star * now.left, E_star * now.right",
    "L_N": "E_star * {left}, E_star * {right}",
    "pressure": "E_star * p",
}
"""What each function returns of what the quadrature found; a few by names of local variables."""


class IntegratedText(CallingText):
    """The text of one function that is integrated."""

    @property
    def _code(self) -> Iterator[str]:
        _, given = own_parameters(self.sheet)
        ends = {side: local(self.sheet, side) for side in ("left", "right")}
        match self.function.name:
            case "pressure":
                yield f"    p = pressure_at(_BODY, x, a, c{given})"
            case "L_N":
                yield f"    {', '.join(ends.values())} = second_of(_BODY, a, c{given})"
            case _:
                yield f"    now = state_of(_BODY, a, c{given})"
        yield from self._ending({"": _RETURNED[self.function.name].format(**ends)})

    @property
    def _further_checks(self) -> Iterator[str]:
        if self.function.name == "pressure":
            yield "x == x"
        elif self.function.name != "L_N":
            yield "now.load < np.inf"


_FIELDS = {
    "tilt": ("tilt",),
    "load": ("load",),
    "moment": ("moment",),
    "K_N": ("left", "right"),
    "L_N": ("second_left", "second_right"),
    "pressure": ("p",),
}
"""What the quadrature calls the results of each function."""


class MendedText(FunctionText):
    """The text of a closed function that is integrated where it would lose digits."""

    _arrays, _bare = LABORIOUS, ()

    def _result(self, _: dict[str, str]) -> Iterator[str]:
        """The terms of every formula, one by one, so that their cancelling shows."""
        steps = {step.symbol for step in self.program.steps}
        printer = NumPyPrinter({a, c, x, *steps})
        fields, outputs = _FIELDS[self.function.name], self.program.outputs.values()
        held = []
        for field, expr in zip(fields, outputs, strict=True):
            terms = terms_of(expr, frozenset(expr.free_symbols - steps | {Symbol("h")}))
            terms.sort(key=lambda term: term.could_extract_minus_sign())
            held.append(f"{field!r}: ({' '.join(f'{printer.doprint(t)},' for t in terms)})")
        yield from _found(self, f"mended_sums({{{', '.join(held)}}}, exists, {_mending(self)})")

    @property
    def _further_checks(self) -> Iterator[str]:
        if self.function.name == "pressure":
            yield "x == x"

    @property
    def _existence(self) -> str:
        places = ["terms of the formula cancel"]
        if self.sheet.frame.kinks:
            places.append("a kink lies close to an edge or to another kink")
        return f"{super()._existence}.  Where {', or '.join(places)}, by quadrature of g''"


def mended_lines(made: FunctionText, values: dict[str, str]) -> Iterator[str]:
    """The closed values, and the call that integrates them where they would lose digits."""
    guarded = f"only_where(exists, {', '.join(values.values())})"
    names = "".join(f"{name!r}, " for name in values)
    yield from _found(made, f"mended({guarded}, exists, ({names}), {_mending(made)})")


def _mending(made: FunctionText) -> str:
    """What the quadrature in a formula's place is given."""
    _, own = own_parameters(made.sheet)
    scale = "E_star" if E_star in made.keywords else "1.0"
    at = ", x=x" if x in made.function.arguments else ""
    return f"{scale}, _BODY, a, c{at}{own}"


def _found(made: FunctionText, call: str) -> Iterator[str]:
    kind, found = made.function.kind, local(made.sheet, "found")
    yield f"    {found} = {call}"
    yield f"    return {kind}(*{found})" if kind else f"    return {found}[0]"


def is_mended(sheet: FormulaSheet) -> bool:
    """Whether closed formulas lose digits somewhere.

    Where a contact can leave a kink, and where powers of places cancel.
    """
    slope = sheet.geometry.slope
    leaves = slope.is_polynomial and any(k.clipped for k in sheet.frame.kinks)
    return leaves or cancels(slope)


def keeps_its_digits(sheet: FormulaSheet, name: str) -> bool:
    """Whether a closed formula does so all the same: the pressure of corners alone.

    p = (E*/pi) sum of jump_j L_j, and every jump of a convex body is positive: nothing cancels.
    """
    return name == "pressure" and all(piece.straight for piece in sheet.geometry.slope.pieces)


def curve_text(sheet: FormulaSheet) -> str:
    """The body's breaks, corners and pieces, and `_BODY` that holds them."""
    slope = sheet.geometry.slope
    places, pieces = cuts_of(slope)
    own, _ = own_parameters(sheet)
    signature = f"({own.removeprefix(', ')})"
    printer = NumPyPrinter()
    steps = {kink.position: kink.step for kink in slope.kinks}
    corners = [steps.get(place, S.Zero) for place in places]
    lines = [
        *breaks_text(sheet),
        *_tuple_of("_corners", "By how much g' rises at the breaks.", corners, signature, printer),
    ]
    held = []
    for i, piece in enumerate(pieces):
        names = []
        for side, place in (("left", piece.lower), ("right", piece.upper)):
            name = f"_piece_{i}_from_{side}" if place.is_finite else "None"
            names.append(name)
            if place.is_finite:
                sense = 1 if side == "left" else -1
                signature = f"(t: Array{own})"
                lines += _branch(name, piece, place, sense, signature)
        held.append(f"Piece({', '.join(names)}{', straight=True' * piece.straight})")
    terms = ""
    if any(has_sharp_power(piece.profile, x) for piece in slope.pieces):
        terms = ", sharp=True"
    if cancels(slope):
        lines += _terms_text(sheet)
        terms += ", terms=_terms"
    if is_mended(sheet) and (cuts := plain_cuts(slope)):
        terms += f", plain={cuts}"
    smooth = [i for i, sides in enumerate(pairwise(pieces)) if _goes_on(*sides)]
    if smooth:
        terms += f", smooth=({' '.join(f'{i},' for i in smooth)})"
    if slope.is_polynomial:
        terms += f", degree={degree_of_curvature(slope)}"
    lines.append(f"_BODY = Profile(_breaks, _corners, ({', '.join(held)},){terms})")
    return "\n".join(lines)


def _goes_on(left: Piece, right: Piece) -> bool:
    """Whether g' and g'' are known to go on from one piece to the next without a jump."""
    off = left.profile - right.profile
    if not off.is_polynomial(x):
        return False
    return all(simplify(diff(off, x, n).subs(x, right.lower)) == 0 for n in (1, 2))


def degree_of_curvature(slope: Slope) -> int:
    """The degree of g'' on the piece where it is highest."""
    curved = (piece.curvature for piece in slope.pieces if not piece.straight)
    return max((int(Poly(curvature, x).degree()) for curvature in curved), default=0)


def _terms_text(sheet: FormulaSheet) -> Iterator[str]:
    """`_terms` of one body."""
    size, farthest = size_of_terms(sheet.geometry.slope)
    own, _ = own_parameters(sheet)
    printer = NumPyPrinter({a, c})
    yield f"def _terms(a: Array, c: Array{own}) -> Array:"
    yield '    """How large the terms of g\' are that the closed formulas add up."""'
    yield f"    x = {printer.doprint(farthest)}  # how far the contact reaches from the origin [m]"
    yield f"    return {printer.doprint(size)}"
    yield ""


def breaks_text(sheet: FormulaSheet) -> Iterator[str]:
    """`_breaks` of one body."""
    places, _ = cuts_of(sheet.geometry.slope)
    own, _ = own_parameters(sheet)
    signature = f"({own.removeprefix(', ')})"
    return _tuple_of("_breaks", "Where the curve is cut.", places, signature, NumPyPrinter())


def _tuple_of(
    name: str,
    words: str,
    values: tuple[Expr, ...] | list[Expr],
    signature: str,
    printer: NumPyPrinter,
) -> Iterator[str]:
    yield f"def {name}{signature} -> tuple[Array, ...]:"
    yield f'    """{words}"""'
    yield f"    return ({' '.join(f'{printer.doprint(value)},' for value in values)})"
    yield ""


def _branch(name: str, piece: Piece, place: Expr, sense: int, signature: str) -> Iterator[str]:
    """g', g'' and t g''' at t beside a break."""

    def rates(expr: Expr) -> list[Expr]:
        return [sense * _rate(term) for term in Add.make_args(expr)]

    given = piece.slope.subs(x, place + sense * _t)
    slope = _shortest(simplify, Add.make_args(given))
    curvature = _shortest(_positive_form, rates(slope), is_positive=True)
    change = _shortest(simplify, [_t * rate for rate in rates(curvature)])
    risen = from_zero(given, _t)
    kept = from_zero(slope, _t) if risen == given else risen
    curves = [kept, from_zero(curvature, _t), change]
    found = cse([decaying(curve, _t) for curve in curves], symbols=_named("s_", curves))
    steps, values = _roots_once(*found)
    printer = NumPyPrinter({_t, *(symbol for symbol, _ in steps)})
    side = "right" if sense > 0 else "left"
    yield f"def {name}{signature} -> Curve:"
    yield f"    \"\"\"g', g'' and t g''' at t on the {side} of a break.\"\"\""
    for symbol, value in steps:
        yield f"    {symbol} = {printer.doprint(value)}"
    first, second, third = (printer.doprint(value) for value in values)
    yield f"    return Curve({first}, {second}, lambda: {third})"
    yield ""


class _tanh(Function):
    """A hyperbolic tangent whose rate is no difference."""

    nargs = 1

    def fdiff(self, _: int = 1) -> Expr:
        """1/cosh(z)**2, not 1 - tanh(z)**2, whose digits are lost far from zero."""
        return cosh(self.args[0]) ** -2


def _rate(expr: Expr) -> Expr:
    """The derivative.

    >>> from sympy import tanh
    >>> _rate(tanh(2 * _t))
    2/cosh(2*t)**2
    """
    return diff(expr.replace(tanh, _tanh), _t).replace(_tanh, tanh)


def _named(stem: str, beside: list[Expr]) -> Iterator[Symbol]:
    """Symbols by number, with names that none has beside them."""
    taken = [Symbol(symbol.name) for symbol in Tuple(*beside).free_symbols]
    return iter(numbered_symbols(stem, exclude=taken))


def _roots_once(steps: Steps, values: list[Expr]) -> tuple[Steps, list[Expr]]:
    """Several half powers of t or of one step by its root, which is a step of its own.

    >>> from sympy import Rational, symbols
    >>> s, y = symbols("s y", positive=True)
    >>> _roots_once([(s, _t + 1)], [y / sqrt(s), y / s ** Rational(3, 2)])
    ([(s, t + 1), (r_0, sqrt(s))], [y/r_0, y/(r_0*s)])
    """
    powers: dict[Expr, set[Pow]] = {base: set() for base in (_t, *(name for name, _ in steps))}
    for power in Tuple(*values, *(value for _, value in steps)).atoms(Pow):
        if power.base in powers and power.exp.is_Rational and power.exp.q == 2:
            powers[power.base].add(power)
    named, shared, roots = _named("r_", values + [value for _, value in steps]), {}, {}
    for base in [base for base, found in powers.items() if len(found) > 1]:
        roots[base] = next(named)
        for power in powers[base]:
            sense = 1 if power.exp > 0 else -1
            shared[power] = base ** (power.exp - S(sense) / 2) * roots[base] ** sense
    found = [(roots[_t], sqrt(_t))] if _t in roots else []
    for name, value in steps:
        found.append((name, value.xreplace(shared)))
        found += [(roots[name], sqrt(name))] if name in roots else []
    return found, [value.xreplace(shared) for value in values]


def _positive_form(curvature: Expr) -> Expr:
    """A form of g'' without a difference, if there is one."""
    return factor(simplify(curvature))


def _shortest(
    form: Callable[[Expr], Expr], terms: Sequence[Expr], is_positive: bool = False
) -> Expr:
    """A form of a sum, whole or term by term, whichever is shorter.

    is_positive: term by term only if none of them is known to be subtracted.

    >>> _shortest(simplify, [1 / (1 + _t), 1 / (2 + _t)])
    1/(t + 2) + 1/(t + 1)
    """
    forms, whole = [form(term) for term in terms], form(Add(*terms))
    apart = Add(*map(_joined, forms))
    subtracts = is_positive and any(term.is_nonpositive for term in forms)
    return _joined(whole) if subtracts or whole.count_ops() <= apart.count_ops() else apart


def _joined(expr: Expr) -> Expr:
    """t^k/t^2 as t^(k - 2), k a parameter or pi: apart, both are 0 at a t that its power may reach.

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
    """Whether a power is no whole one and no half one, or may be none: k, pi, 7/3."""
    return not (2 * exponent).is_integer


def carried_text(sheet: FormulaSheet, found: str) -> str:
    """`_state`: what a contact carries.

    found: the code that finds it.
    """
    own, _ = own_parameters(sheet)
    return "\n".join(
        [
            f"def _state(a: Array, c: Array{own}) -> State:",
            '    """What the contact [-a, c] carries for E* = 1, and its edge coefficients."""',
            f"    return {found}",
        ]
    )


def level_text(sheet: FormulaSheet, found: str) -> str:
    """`_slope`: the body's slope and curvature at a place; infinite beyond the body's ends.

    found: the code that finds them.
    """
    own, _ = own_parameters(sheet)
    printer = NumPyPrinter({x})
    slope, curvature = local(sheet, "slope"), local(sheet, "curvature")
    beyond = [
        f"    {slope} = np.where(x {side} {printer.doprint(end)}, {infinite}, {slope})"
        for end, side, infinite in zip(
            sheet.geometry.slope.domain, ("<=", ">="), ("-np.inf", "np.inf"), strict=True
        )
        if end.is_finite
    ]
    return "\n".join(
        [
            f"def _slope(x: Array{own}) -> tuple[Array, Array]:",
            '    """g\'(x) and g\'\'(x)."""',
            *(
                [
                    f"    {slope}, {curvature} = {found}",
                    *beyond,
                    f"    return {slope}, {curvature}",
                ]
                if beyond
                else [f"    return {found}"]
            ),
        ]
    )
