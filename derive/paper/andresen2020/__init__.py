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

from functools import cache

from derive.paper.claim import Paper

TITLE = (
    "H. Andresen, R. M. N. Fleury, M. R. Moore, D. A. Hills: Explicit and asymptotic solutions for "
    "frictional incomplete half-plane contacts subject to general oscillatory loading in the "
    "steady-state (2020)"
)


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
    return Paper(TITLE, tuple(claim for section in sections for claim in section.claims()))
