"""The third coefficient of the pressure next to the edges, of s**(5/2).

In:  a proven FormulaSheet.
Out: the text of `_third`, for series of the slip zones to order 3; none for a body whose integrals
     have no closed form, or whose formulas would lose digits and are no sums over parabolas.
"""

from collections.abc import Iterator
from itertools import pairwise

from sympy import Expr, simplify

from derive.codegen.cancel import cuts_of
from derive.codegen.contract import Function
from derive.codegen.function import BareText, CallingText
from derive.codegen.integrated import is_mended
from derive.codegen.parabolas import body_of, is_parabolic
from derive.codegen.rewrite import prove_equal
from derive.errors import NotProven
from derive.sheet import FormulaSheet
from derive.symbols import a, c
from derive.theory.edges import Edge, pressure_series
from derive.theory.slip import pressure_next

NAME = "_third"

_THIRD = Function(
    NAME,
    (a, c),
    (("left", "L_N_left"), ("right", "L_N_right")),
    "Coefficients of s**(5/2) in the pressure next to the edges.",
    kind="Edges",
)
"""Its conditions are those of L_N."""


def has_third(sheet: FormulaSheet) -> bool:
    """Whether there is a formula for it, or a sum, that keeps its digits."""
    return is_parabolic(sheet) or (sheet.geometry.slope.is_polynomial and not is_mended(sheet))


def third_text(sheet: FormulaSheet, source: str) -> str:
    """`_third` of one body.

    Raises NotProven if the expanded pressure is not what L_N and K_N say.
    """
    made = _SummedText if is_parabolic(sheet) else _ExpandedText
    return made(sheet, _THIRD, source).text


def smooth_cuts(sheet: FormulaSheet) -> tuple[int, ...]:
    """Numbers of the cuts of a body without closed formulas that one curve goes across."""
    slope = sheet.geometry.slope
    if slope.is_polynomial:
        return ()
    _, pieces = cuts_of(slope)
    sides = enumerate(pairwise(pieces))
    return tuple(i for i, (left, right) in sides if simplify(left.profile - right.profile) == 0)


class _SummedText(BareText, CallingText):
    """Added up part by part."""

    @property
    def _code(self) -> Iterator[str]:
        yield f"    return Edges(*(E_star * edge for edge in {body_of(self.sheet)}.third(a, c)))"


class _ExpandedText(BareText):
    """The pressure expanded once more."""

    def _expressions(self) -> dict[str, Expr]:
        return {edge.name.lower(): pressure_series(self.sheet.frame, edge, 3)[2] for edge in Edge}

    def _demand_equal(self) -> None:
        """The code against the other route: how L_N changes as the edge alone moves."""
        super()._demand_equal()
        proof = prove_equal(self.program, _from_motion(self.sheet), self._points())
        if not proof.holds:
            raise NotProven(f"{NAME} of {self.sheet.geometry.name!r}: {proof}")


def _from_motion(sheet: FormulaSheet) -> dict[str, Expr]:
    found = {}
    for side, edge in (("left", a), ("right", c)):
        K, L = (sheet.frame.flat(sheet[f"{name}_{side}"].expr) for name in ("K_N", "L_N"))
        found[side] = sheet.frame.flat(pressure_next(L.diff(edge), 1, K))
    return found
