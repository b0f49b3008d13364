"""What the inverses solve, written with the formulas of the sheet in many digits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import mpmath
from mpmath import mpf

from derive.proof.points import numeric
from tests.accuracy.reference import Conditions, function_of, sheet_of

Formula = Callable[..., mpf]


@cache
def formula(body: str, name: str) -> Formula:
    """One formula of a body's sheet, by keywords; what it does not hold is left aside."""
    sheet = sheet_of(body)
    expr = sheet.flat(name)
    if sheet.geometry.slope.is_polynomial:
        names, function = function_of(expr)
        return lambda **given: mpmath.re(function(*(given[n] for n in names)))
    symbols, by_integrals = expr.free_symbols, numeric(expr)
    return lambda **given: by_integrals({s: given[str(s)] for s in symbols})


@dataclass(frozen=True)
class Inverse:
    """Arguments of an inverse, and the formulas that give them back from a and c."""

    arguments: tuple[str, ...]
    formulas: tuple[str, ...]

    def conditions(self, body: str) -> Conditions:
        """What vanishes at the contact."""
        laws = [formula(body, name) for name in self.formulas]

        def off(edges: Sequence[mpf], given: Mapping[str, mpf]) -> list[mpf]:
            held = {**given, "a": edges[0], "c": edges[1]}
            pairs = zip(laws, self.arguments, strict=True)
            return [law(**held) - given[name] for law, name in pairs]

        return off


INVERSES = {
    "contact": Inverse(("P", "M"), ("load", "moment")),
    "contact_at_tilt": Inverse(("P", "alpha"), ("load", "tilt")),
}
