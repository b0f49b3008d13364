"""All symbols of the theory, each with its meaning, unit and assumptions.

The whole project uses one sign convention.  x points to the right, and the tilt alpha is positive
anticlockwise.  The contact is [-a, c] with signed a and c.  M = -int p x dx, so that a symmetric
body with M > 0 has alpha > 0.  If dsigma > 0 and dQ > 0, the left edge is loaded more than the
right edge.
"""

from dataclasses import dataclass

from sympy import Symbol, sqrt


@dataclass(frozen=True)
class Quantity:
    """A symbol with its meaning and unit."""

    symbol: Symbol
    meaning: str
    unit: str
    latex: str = ""

    @property
    def name(self) -> str:
        """Name in code and in commands."""
        return str(self.symbol.name)


x = Symbol("x", real=True)
a = Symbol("a", real=True)
c = Symbol("c", real=True)
alpha = Symbol("alpha", real=True)
E_star = Symbol("E_star", positive=True)
P = Symbol("P", positive=True)
M = Symbol("M", real=True)
e = Symbol("e", real=True)
s = Symbol("s", positive=True)
f = Symbol("f", positive=True)
dQ = Symbol("dQ", nonnegative=True)
dsigma = Symbol("dsigma", real=True)
dP = Symbol("dP", real=True)
dM = Symbol("dM", real=True)
m = Symbol("m", real=True)
n = Symbol("n", real=True)

h = a + c
"""Contact width."""
mid = (c - a) / 2
"""Midpoint of the contact."""
w = sqrt((a + x) * (c - x))
"""Square root that vanishes at both edges."""

_TABLE = (
    Quantity(x, "position along the interface, positive to the right", "m"),
    Quantity(a, "left edge of the contact at x = -a", "m"),
    Quantity(c, "right edge of the contact at x = c", "m"),
    Quantity(alpha, "tilt, positive anticlockwise: the slope in contact is g'(x) + alpha", "rad"),
    Quantity(
        E_star,
        "composite modulus, 1/E* = 2 (1 - nu^2)/E for similar bodies in plane strain",
        "Pa",
        "E^{*}",
    ),
    Quantity(P, "normal load per unit depth", "N/m"),
    Quantity(M, "moment per unit depth, M = -int p x dx", "N"),
    Quantity(e, "lever arm M/P: the load acts at x = -e", "m"),
    Quantity(s, "distance inward from an edge", "m"),
    Quantity(f, "coefficient of friction", "-"),
    Quantity(dQ, "change in the shear load over the half-cycle that raises it", "N/m", r"\Delta Q"),
    Quantity(
        dsigma,
        "change in the differential bulk tension over the same half-cycle",
        "Pa",
        r"\Delta\sigma",
    ),
    Quantity(m, "left end of the permanent stick zone at x = -m", "m"),
    Quantity(n, "right end of the permanent stick zone at x = n", "m"),
    Quantity(dP, "change in the normal load over the same half-cycle", "N/m", r"\Delta P"),
    Quantity(dM, "change in the moment over the same half-cycle", "N", r"\Delta M"),
)

QUANTITIES: dict[str, Quantity] = {q.name: q for q in _TABLE}

_ALSO_USED = (
    # names used by the theory
    *("da", "dc", "dq", "d_left", "d_right", "h", "kappa", "lambda", "m", "mid", "n"),
    *("p", "pi", "q", "Q", "sigma", "t", "theta", "xi"),
    # names used by SymPy
    *("E", "I", "N", "O", "oo", "nan", "inf"),
    # names used by the generated modules
    *("np", "Any", "LEAST", "MOST", "TINY", "evaluated", "where", "kink_logarithm"),
    *("Body", "Curve", "cycle", "shared", "Values"),
    *(
        "segment",
        "involute",
        "edge_angle",
        "part_area",
        "part_arm",
        "part_weight",
        "end_pressure",
        "part_pressure",
        "root_ratio",
    ),
    *("r_left", "r_right", "k_left", "k_right"),
    *("second_term", "curve_of", "excess", "polynomial", "kernel"),
    *("Array", "exists", "first", "second", "order", "mixed", "own", "piece", "side"),
    *("contact", "contact_at_tilt", "tilt", "load", "moment", "pressure", "pieces"),
    *("K_N", "L_N", "K_T", "L_T", "K_Q", "stick_zone", "why", "tension_threshold", "slip_zones"),
    *("Contact", "Edges", "StickZone", "Threshold", "Regime", "March"),
    *("stick_margin", "shear", "shear_change", "slip_error", "slip_range", "slip_terms"),
    *("march", "history", "steady_cycle", "full_stick", "runtime"),
    *("History", "SteadyCycle", "public", "tol"),
)

RESERVED: frozenset[str] = frozenset(QUANTITIES) | frozenset(_ALSO_USED)
"""Names that no parameter may have; names such as theta_1, w_1, L_1, q_left_1, m_1 or sin_x are
reserved, too."""
