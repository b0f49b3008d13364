"""The meaning of each regime, and the reason why a cycle has no regime, in words."""

import math
from collections.abc import Iterator, Mapping

from .types import Regime

MEANINGS = {
    Regime.MODERATE: "both edges slip forward: m and n are exact",
    Regime.LARGE: "the edges slip in opposite directions: m and n are exact",
    Regime.MIXED: "slip reverses within a half-cycle: use stick_zone(..., mixed=True) for constant "
    "normal loads, or steady_cycle for any loads",
    Regime.SLIDING: "dQ reaches f (P_1 + P_2): the contact slides and nothing sticks",
    Regime.FULL_STICK: "the whole contact sticks: nothing slips",
    Regime.UNSOLVED: "the iteration did not converge, the phases of a mixed cycle were not found, "
    "as under very large tension, or the tilts do not determine the edges to 1e-6 of the width: "
    "use steady_cycle, which estimates its error",
}


def reason(
    regime: Regime,
    constants: Mapping[str, float],
    changes: Mapping[str, float],
    edges: Mapping[str, tuple[float, float]],
    demands: str,
) -> str:
    """The meaning of a regime in words; for NONE, everything that is wrong with the numbers.

    constants  f, E* and the body's parameters, which must be positive
    changes    dQ and dsigma
    edges      a and c of each contact, by its name
    demands    further conditions on the parameters
    """
    if regime in MEANINGS:
        return MEANINGS[regime]
    wrong = [*_wrong_numbers(constants, changes), *_wrong_edges(edges)]
    if not wrong:
        wrong = [
            "first or second is not a contact [-a, c] of the body under any load and tilt: pass "
            "contacts returned by contact(...)"
        ]
        if demands:
            wrong.append(f"the body's parameters must satisfy {demands}")
    return "; ".join(wrong)


def _wrong_numbers(constants: Mapping[str, float], changes: Mapping[str, float]) -> Iterator[str]:
    for name, value in constants.items():
        if not 0 < value < math.inf:
            yield f"{name} = {value:g} is not positive and finite"
    for name, value in changes.items():
        if not math.isfinite(value):
            yield f"{name} = {value:g} is not finite"
        elif name == "dQ" and value < 0:
            yield f"dQ = {value:g} is negative: pass the half-cycle that raises the shear load"


def _wrong_edges(edges: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    for name, (a, c) in edges.items():
        if not math.isfinite(a + c):
            yield f"{name} is NaN: there is no contact under its loads"
        elif a + c <= 0:
            yield f"{name} has a + c = {a + c:g}: the width of a contact [-a, c] must be positive"
