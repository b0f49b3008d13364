"""What a regime means, and why a cycle has none, in words."""

import math
from collections.abc import Iterator, Mapping

from .types import Regime

MEANINGS = {
    Regime.MODERATE: "slip runs forward at both edges: m and n are exact",
    Regime.LARGE: "slip has opposite signs at the edges: m and n are exact",
    Regime.MIXED: "slip reverses within a half-cycle: stick_zone(..., mixed=True) solves it at "
    "constant normal loads, and steady_cycle at any",
    Regime.SLIDING: "dQ reaches f (P1 + P2): the contact slides, and nothing sticks",
    Regime.FULL_STICK: "friction holds everywhere: nothing slips",
    Regime.UNSOLVED: "the iteration did not end, or the tilts do not tell the edges to 1e-6 of the "
    "width: steady_cycle answers, with an estimate of its error",
}


def reason(
    regime: Regime,
    constants: Mapping[str, float],
    changes: Mapping[str, float],
    edges: Mapping[str, tuple[float, float]],
    demands: str,
) -> str:
    """A regime in words; where there is none, all that is wrong with a cycle's numbers.

    constants  f, E* and the body's parameters, which must be positive
    changes    dQ and dsigma
    edges      a and c of each contact, by its name
    demands    what the parameters must meet besides
    """
    if regime in MEANINGS:
        return MEANINGS[regime]
    wrong = [*_wrong_numbers(constants, changes), *_wrong_edges(edges)]
    if not wrong:
        wrong = ["no load and tilt press the body on [-a, c] of first and of second"]
        if demands:
            wrong.append(f"its parameters must meet {demands}")
    return "; ".join(wrong)


def _wrong_numbers(constants: Mapping[str, float], changes: Mapping[str, float]) -> Iterator[str]:
    for name, value in constants.items():
        if not 0 < value < math.inf:
            yield f"{name} = {value:g} is not positive and finite"
    for name, value in changes.items():
        if not math.isfinite(value):
            yield f"{name} = {value:g} is not finite"
        elif name == "dQ" and value < 0:
            yield f"dQ = {value:g} is negative: give the half-cycle that raises the shear load"


def _wrong_edges(edges: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    for name, (a, c) in edges.items():
        if not math.isfinite(a + c):
            yield f"{name} is NaN: there is no contact under its loads"
        elif a + c <= 0:
            yield f"{name} has a + c = {a + c:g}: a contact [-a, c] has a width above zero"
