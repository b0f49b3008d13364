"""What the inverses solve, written with the formulas of the sheet in many digits."""

from collections.abc import Sequence
from dataclasses import dataclass

from mpmath import mpf

from tests.accuracy.definitions import formula
from tests.accuracy.reference import Given, Problem


@dataclass(frozen=True)
class Inverse:
    """Arguments of an inverse, and the formulas that give them back from a and c."""

    arguments: tuple[str, ...]
    formulas: tuple[str, ...]

    def problem(self, body: str, digits: int) -> Problem:
        """What vanishes at the contact."""
        laws = [formula(body, name) for name in self.formulas]

        def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
            held = {**given, "a": edges[0], "c": edges[1]}
            pairs = zip(laws, self.arguments, strict=True)
            return [law(**held) - given[name] for law, name in pairs]

        return Problem(off, digits=digits)


INVERSES = {
    "contact": Inverse(("P", "M"), ("load", "moment")),
    "contact_at_tilt": Inverse(("P", "alpha"), ("load", "tilt")),
}
