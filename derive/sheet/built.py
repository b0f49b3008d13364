"""A finished body, as the pipeline returns it.

It is passed between processes and therefore contains only plain data and no expressions.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from derive.proof.verdict import Verdict

_PARTS = {
    "forward": "load",
    "from (P, M)": "contact_a",
    "from (P, alpha)": "contact_at_tilt_a",
}
"""Parts of a contact law, each with the formula that exists only if the part is in closed form."""


@dataclass(frozen=True)
class BuiltBody:
    """The result of building one body.

    name       name of the body and of its module
    text       text of the module
    stuck      text of the module for full stick, which is the same for all bodies
    seconds    time from reading g(x) to the finished text
    closed     parts of the contact law that are closed formulas
    numerical  parts of the contact law that are computed numerically
    verdicts   verdict on every formula
    """

    name: str
    text: str
    stuck: str
    seconds: float = field(compare=False)
    closed: tuple[str, ...]
    numerical: tuple[str, ...]
    verdicts: tuple[tuple[str, Verdict], ...]

    def formulas(self, verdict: Verdict) -> tuple[str, ...]:
        """Names of the formulas with this verdict."""
        return tuple(name for name, own in self.verdicts if own == verdict)


def by_form(is_closed: Callable[[str], bool]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Separate the parts of a contact law into closed formulas and numerical ones.

    is_closed: tells whether the formula of a given name is closed.

    A part belongs to both groups if it has a closed form in special functions although the
    generated code evaluates its integral.

    >>> by_form({"load", "contact_a"}.__contains__)
    (('forward', 'from (P, M)'), ('from (P, alpha)',))
    >>> by_form({"load_closed"}.__contains__)
    (('forward by special functions',), ('forward in code', 'from (P, M)', 'from (P, alpha)'))
    """
    closed, numerical = [], []
    for part, formula in _PARTS.items():
        if is_closed(formula):
            closed.append(part)
        elif is_closed(f"{formula}_closed"):
            closed.append(f"{part} by special functions")
            numerical.append(f"{part} in code")
        else:
            numerical.append(part)
    return tuple(closed), tuple(numerical)
