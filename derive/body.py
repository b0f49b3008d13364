"""One body at the end of the pipeline, as plain data.

It is passed between processes and stored in files, so it holds no expressions.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from derive.proof.verdict import Verdict

_PARTS = {
    "forward": "load",
    "from (P, M)": "contact_a",
    "from (P, alpha)": "contact_at_tilt_a",
}
"""Parts of a contact law, and the formula whose presence means that the part is closed form."""


@dataclass(frozen=True)
class Body:
    """The result of building one body.

    name       the body's name, and its module's
    text       the module
    stuck      the module of full stick, which is the same for all bodies
    seconds    from reading g(x) to the text
    closed     parts of its contact law that are closed formulas
    numerical  parts that are computed numerically
    verdicts   the verdict on every formula
    proofs     how every formula was proved, in words
    struck     the message if the search for closed forms reached its time limit
    kept       whether it comes from an earlier run
    """

    name: str
    text: str
    stuck: str
    seconds: float = field(compare=False)
    closed: tuple[str, ...]
    numerical: tuple[str, ...]
    verdicts: tuple[tuple[str, Verdict], ...]
    proofs: tuple[tuple[str, str], ...] = field(compare=False)
    struck: str = ""
    kept: bool = field(default=False, compare=False)

    def formulas(self, verdict: Verdict) -> tuple[str, ...]:
        """Names of the formulas with this verdict."""
        return tuple(name for name, found in self.verdicts if found == verdict)


def by_form(is_closed: Callable[[str], bool]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Which parts of a contact law are closed formulas, and which are not.

    is_closed: whether the formula of this name is closed.

    A part with a closed form in special functions whose integral is evaluated in code is both.

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
