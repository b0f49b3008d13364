"""Andresen, Fleury, Moore & Hills 2020, equation by equation.

    introduction   section 1            eq. (1)
    mossakovskii   section 2            eqs. (2) to (9)
    asymptotics    section 3            eqs. (10) to (20)
    wedge          section 4            eqs. (21) to (34)
    results        section 5            eqs. (35) to (39)
    hertz          appendix             eqs. (40) to (48)
    large          both conditions of the stick zone under large tension
    consequences   what the errors do to a user's numbers
    symbols        the paper's notation

Equations are counted through as they are printed; the definitions below eq. (47), which bear no
number, are called (47a).  M, P and all else mean what the section says that they mean; where it
says nothing, what an earlier one says.
"""

from dataclasses import replace
from functools import cache

from derive.paper.claim import Paper

TITLE = (
    "H. Andresen, R. M. N. Fleury, M. R. Moore, D. A. Hills: Explicit and asymptotic solutions for "
    "frictional incomplete half-plane contacts subject to general oscillatory loading in the "
    "steady-state (2020)"
)

_SECONDS = 120.0
"""That any claim may take; the longest takes about five."""

SIGNS = {
    "moment": (
        *("fullstickinequality/left", "fullstickinequality/right", "alpha"),
        *("section 4.1/M/integral", "section 4.1/M/value"),
    ),
    "tilt": ("gamma", "section 4.1/c", "gamma_2", "section 4.1/alpha_0"),
    "tension": (
        *("fullstickinequality/left", "fullstickinequality/right", "section 3/K_T/left"),
        *("gamma_2", "K_T/left", "K_T/right", "inequalitywedge", "eq18"),
        *("Hertz_shift_stick_zone", "eq26"),
    ),
    "shear": (
        *("fullstickinequality/left", "section 3/K_T/left", "section 3/K_T/right"),
        *(
            "eq:CJshear/sense",
            "eq:slipAsymptotes/1",
            "eq:slipAsymptotes/2",
            "K_T/left",
            "K_T/right",
        ),
    ),
}
"""Claims by which the sections can be compared: which sign each gives to a quantity."""


@cache
def paper() -> Paper:
    """All claims, in the order of the pages."""
    from derive.paper.andresen2020 import (
        asymptotics,
        hertz,
        introduction,
        mossakovskii,
        results,
        wedge,
    )

    sections = (introduction, mossakovskii, asymptotics, wedge, results, hertz)
    claims = (claim for section in sections for claim in section.claims())
    return Paper(TITLE, tuple(replace(claim, seconds=_SECONDS) for claim in claims), SIGNS)
