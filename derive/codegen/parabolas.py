"""Functions of a body of straight lines and parabolas, where a contact can leave a kink.

In:  a proven FormulaSheet.
Out: the text of `_body`, its kinks and the pieces between, and of the functions that add up what
     these carry.  The sums, in which no terms cancel, are support/_parabolas.py.
"""

from collections.abc import Iterator
from itertools import pairwise

from sympy import Expr, simplify

from derive.codegen.function import CallingText, own_parameters
from derive.codegen.integrated import degree_of_curvature, is_mended
from derive.codegen.memory import BY_PARTS, PRESSURE_BY_PARTS
from derive.codegen.printer import NumPyPrinter
from derive.piece import Piece
from derive.sheet import FormulaSheet
from derive.symbols import x

_SUMS = {
    "tilt": "{body}.tilt(a, c)",
    "load": "E_star * {body}.load(a, c)",
    "moment": "E_star * {body}.moment(a, c)",
    "K_N": "*(E_star * edge for edge in {body}.edges(a, c))",
    "L_N": "*(E_star * edge for edge in {body}.second(a, c))",
    "pressure": "E_star * {body}.pressure(x, a, c)",
}
"""What each function returns where there is a contact."""


def is_parabolic(sheet: FormulaSheet) -> bool:
    """Whether closed formulas would lose digits, and g'' is constant on every piece."""
    return is_mended(sheet) and degree_of_curvature(sheet.geometry.slope) == 0


class ParabolicText(CallingText):
    """The text of one function that is added up from its parts."""

    @property
    def _arrays(self) -> int:
        return PRESSURE_BY_PARTS if self.function.name == "pressure" else BY_PARTS

    @property
    def _code(self) -> Iterator[str]:
        yield from self._ending({"": _SUMS[self.function.name].format(body=body_of(self.sheet))})

    @property
    def _further_checks(self) -> Iterator[str]:
        """Parameters of a part that is not in contact are checked all the same."""
        kinks = self.sheet.geometry.slope.kinks
        places = set().union(*(kink.position.free_symbols for kink in kinks))
        for quantity in self.sheet.geometry.parameters:
            least = "LEAST" if quantity.symbol in places and quantity.unit == "m" else "0"
            yield f"{quantity.name} > {least}"
        if self.function.name == "pressure":
            yield "x == x"

    @property
    def _existence(self) -> str:
        how = "Computed part by part between the kinks, where no terms cancel"
        return f"{super()._existence}.  {how}"


def body_of(sheet: FormulaSheet) -> str:
    """The call that gives the body."""
    _, given = own_parameters(sheet)
    return f"_body({given.removeprefix(', ')})"


def body_text(sheet: FormulaSheet) -> str:
    """`_body`, and `_breaks`, where it is cut."""
    slope = sheet.geometry.slope
    places, pieces = [kink.position for kink in slope.kinks], slope.pieces
    own, _ = own_parameters(sheet)
    signature = f"({own.removeprefix(', ')})"
    corners = [(i, kink.step) for i, kink in enumerate(slope.kinks) if kink.is_corner]
    fields = {
        "kinks": map(_printed, places),
        "spans": (_printed(simplify(right - left)) for left, right in pairwise(places)),
        "bends": (_printed_if_any(simplify(piece.curvature)) for piece in pieces),
        "slopes": map(_line, pieces),
    }
    lines = [f"{name}=({' '.join(f'{v},' for v in held)})," for name, held in fields.items()]
    lines.insert(2, f"corners={{{', '.join(f'{i}: {_printed(jump)}' for i, jump in corners)}}},")
    return "\n".join(
        [
            "@looked_up",
            f"def _body{signature} -> Parabolas:",
            '    """Where the curve is cut, and the lines and parabolas between."""',
            "    return Parabolas(",
            *(f"        {line}" for line in lines),
            "    )",
            "",
            f"def _breaks{signature} -> tuple[Array, ...]:",
            '    """Where the curve is cut."""',
            f"    return {body_of(sheet)}.kinks",
        ]
    )


def _line(piece: Piece) -> str:
    """A place and g' there: an end of the piece that g' does not come back to zero from, or its
    root; None where it is zero all over.
    """
    slope, ends = simplify(piece.slope), (piece.lower, piece.upper)
    if slope == 0:
        return "None"
    if piece.straight:
        return f"(0, {_printed(slope)})"
    for end, sense in zip(ends, (1, -1), strict=True):
        there = simplify(slope.subs(x, end)) if end.is_finite else None
        if there is not None and (sense * there).is_nonnegative:
            return f"({_printed(end)}, {_printed(there)})"
    return f"({_printed(simplify(-slope.subs(x, 0) / piece.curvature))}, 0)"


def _printed_if_any(value: Expr) -> str:
    return "None" if value == 0 else _printed(value)


def _printed(value: Expr) -> str:
    return str(NumPyPrinter().doprint(value))
