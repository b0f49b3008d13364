"""The inverses that have no closed formula: contact and contact_at_tilt by Newton's method.

In:  a proven FormulaSheet.
Out: the text of `_state`, what a contact carries, and of the functions that solve it; where a tilt
     is given of `_slope`, too.  The method is support/_solve.py.
"""

from collections.abc import Iterator

from sympy import Expr, Gt, Lt, Piecewise, S, diff, factor
from sympy.logic.boolalg import Boolean

from derive.codegen.contract import Function
from derive.codegen.function import BareText, CallingText, local, own_parameters
from derive.codegen.integrated import is_mended, mended_lines
from derive.codegen.printer import NumPyPrinter
from derive.proof.points import Point, contacts
from derive.sheet import FormulaSheet, load_conditions, tilt_conditions
from derive.symbols import E_star, M, a, alpha, c, x
from derive.units import parse_unit

SOLVED = ("contact", "contact_at_tilt")
"""Functions of the contract that can be solved for."""

_STATE = Function(
    "_state",
    (a, c),
    (
        ("load", "load"),
        ("moment", "moment"),
        ("tilt", "tilt"),
        ("left", "K_N_left"),
        ("right", "K_N_right"),
    ),
    "What the contact [-a, c] carries for E* = 1, and its edge coefficients.",
    kind="State",
    material=False,
)


class StateText(BareText):
    """`_state` of one body: load, moment, tilt and K_N at once, their steps shared."""

    def __init__(self, sheet: FormulaSheet, source: str) -> None:
        super().__init__(sheet, _STATE, source)

    def _expressions(self) -> dict[str, Expr]:
        return {name: expr.subs(E_star, 1) for name, expr in super()._expressions().items()}

    def _result(self, values: dict[str, str]) -> Iterator[str]:
        if is_mended(self.sheet):
            yield from mended_lines(self, values)
            return
        guarded = f"only_where(exists, {values.pop('load')})"
        yield f"    return State({', '.join([guarded, *values.values()])})"


def slope_text(sheet: FormulaSheet) -> str:
    """`_slope` of one body: g'(x) and g''(x)."""
    slope: Expr = sheet.frame.slope.base
    for kink in sheet.frame.slope.kinks:
        compare = Gt if kink.side > 0 else Lt
        beyond = compare(x, kink.position, evaluate=False)
        slope += Piecewise((factor(kink.jump), beyond), (S.Zero, True))
    printer = NumPyPrinter({x})
    own, _ = own_parameters(sheet)
    first, second = local(sheet, "slope"), local(sheet, "curvature")
    return "\n".join(
        [
            f"def _slope(x: Array{own}) -> tuple[Array, Array]:",
            '    """g\'(x) and g\'\'(x)."""',
            f"    {first} = {printer.doprint(slope)}",
            f"    {second} = {printer.doprint(diff(slope, x))}",
            f"    return {first}, {second}",
        ]
    )


class SolvedText(CallingText):
    """The text of one inverse of one body, solved by Newton's method."""

    def _expressions(self) -> dict[str, Expr]:
        return {}

    def _conditions(self) -> tuple[Boolean, ...]:
        bounds = load_conditions(self.sheet.frame)
        if alpha in self.function.arguments:
            bounds = tilt_conditions(self.sheet.frame)
        return (*bounds, *(Gt(symbol, 0, evaluate=False) for symbol in self.keywords))

    @property
    def _sources(self) -> tuple[str, ...]:
        return "load", "moment" if M in self.function.arguments else "tilt"

    @property
    def _equations(self) -> Iterator[str]:
        given = ", ".join(f"{self.sheet[s].symbol} = {s}(a, c)" for s in self._sources)
        yield f"{given}; solved for a and c by Newton's method"
        if M in self.function.arguments:
            yield "alpha = tilt(a, c)"

    @property
    def _returns(self) -> str:
        last = "alpha [rad]" if M in self.function.arguments else "alpha as given"
        return f"Contact(a [m], c [m], {last})"

    @property
    def _existence(self) -> str:
        beside = "beside a kink or " * bool(self.sheet.geometry.slope.kinks)
        rounded = f"the rounding of its edges moves the load by 1e-4, {beside}far from the origin"
        if alpha in self.function.arguments:
            rounded += ", nor where that of alpha moves an edge by a hundredth of the width"
        return f"{super()._existence}, nor where {rounded}.  {self._why}"

    @property
    def _why(self) -> str:
        if any(end.is_finite for end in self.sheet.frame.slope.domain):
            return (
                "None is found with an edge closer to an end of the body than 1e-6 of its distance "
                "from the origin"
            )
        if M in self.function.arguments:
            return (
                "There is a contact for every load and moment: among those of one width, one has "
                "its load's centre at -M/P, and the load grows with the width without limit"
            )
        return "At every such tilt the load grows with the width, from nothing and without limit"

    @property
    def _proofs(self) -> Iterator[str]:
        yield "The derivatives follow from K_N: a contact grows by flat punches."
        yield f"Derived from {self.source}."

    @property
    def _doctest(self) -> Iterator[str]:
        given = dict(zip(self._sources, self.function.arguments, strict=True))
        material = {q: f"{q}={float(self.example[q])!r}" for q in self.keywords}
        call = ", ".join(
            [*(repr(float(self.example[s])) for s in given.values()), *material.values()]
        )
        yield f">>> a, c, alpha = {self.function.name}({call})"
        for name, symbol in given.items():
            needed = [t for q, t in material.items() if name != "tilt" or q != E_star]
            yield f'>>> f"{{{name}({", ".join(["a", "c", *needed])}):.6g}}"'
            yield repr(f"{float(self.example[symbol]):.6g}")

    @property
    def _code(self) -> Iterator[str]:
        _, constants = own_parameters(self.sheet)
        size = _length(self.sheet)
        slope = self.sheet.geometry.slope
        cut = not slope.is_polynomial or is_mended(self.sheet) or slope.kinks
        breaks = f"_breaks({constants.removeprefix(', ')})" if cut else "()"
        if M in self.function.arguments:
            yield (
                f"    a, c, alpha = contact_under("
                f"P / E_star, M / E_star, {size}, _state, {breaks}{constants})"
            )
        else:
            yield f"    place = level(_slope, alpha, {size}, {self._corners}{constants})"
            yield (
                f"    a, c, _ = contact_at("
                f"P / E_star, alpha, place, {size}, _state, {breaks}{constants})"
            )
        held = "alpha" if M in self.function.arguments else "+alpha"
        yield from self._ending({"a": "a", "c": "c", "alpha": held})

    @property
    def _corners(self) -> str:
        printer = NumPyPrinter()
        kinks = self.sheet.frame.slope.kinks
        return "(" + "".join(f"{printer.doprint(k.position)}, " for k in kinks if k.is_corner) + ")"

    def _points(self) -> Iterator[Point]:
        yield from contacts(self.sheet)


def _length(sheet: FormulaSheet) -> str:
    """A length of the body's order: one of its parameters, or P/E* where none has the dimension."""
    for quantity in sheet.geometry.parameters:
        dimension = parse_unit(quantity.unit)
        if dimension.pressure == 0 and dimension.length.is_number and dimension.length > 0:
            root = quantity.symbol ** (1 / dimension.length)
            return str(NumPyPrinter({quantity.symbol}).doprint(root))
    return "P / E_star"
