r"""Propose a formula, a meaning and a unit for the symbols of a draft.

In:   the name of a symbol and the text of the paper.
Out:  a proposal.  The user decides: nothing here changes what is read or judged.
"""

import re
from typing import NamedTuple

_TABLE = """
P; load(a, c); normal load; N/m
M; moment(a, c); moment; N
alpha; tilt(a, c); angle of tilt; rad
a; ; left edge of the contact at x = -a, or half-width; m
b; ; a length of the profile, or half-width; m
c; ; right edge of the contact, or right end of the stick zone; m
m; ; left end of the stick zone; m; stick
n; ; right end of the stick zone; m; stick
d; ; size of a slip zone, or half-width of the stick zone; m; slip|stick
e; ; eccentricity of the stick zone; m; stick
R; ; relative radius of curvature; m
phi; ; angle of a wedge's face; rad; wedge
Q; ; shear load; N/m
sigma; ; differential bulk tension; Pa; tension
E; ; Young's modulus; Pa
nu; ; Poisson's ratio; -
mu; ; coefficient of friction; -; friction
Delta_Q; ; range of the shear load; N/m
Delta_P; ; range of the normal load; N/m
Delta_sigma; ; range of the differential bulk tension; Pa
Delta_q; ; change in the shear traction; Pa
Delta_K_T; ; change in the coefficient of 1/sqrt(s) in the shear traction; Pa*sqrt(m)
Delta_a; ; movement of the edge; m
K_N; K_N_left(a, c); coefficient of sqrt(s) in the pressure; Pa/sqrt(m)
K_T; ; coefficient of 1/sqrt(s) in the shear traction; Pa*sqrt(m)
p; pressure(x, a, c); contact pressure; Pa
p_0; ; maximum contact pressure
q; ; shear traction; Pa
g; ; profile of the body; m
g_prime; ; slope of the profile; rad
F; punch(s, s); weight of the flat punches; Pa; flat(?:-| | rigid )punch
P_prime; load_rate(a, c); slope of the contact law at fixed tilt; Pa
a_prime; edge_ratio(a, c); change in the left edge divided by that in the right one; -
dQ; ; small change in the shear load; N/m
dP; ; small change in the normal load; N/m
dM; ; small change in the moment; N
dsigma; ; small change in the bulk tension; Pa
dP_dc; load_rate(a, c); slope of the contact law at fixed tilt; Pa
dP_da; ; slope of the contact law; Pa
gamma; ; a ratio or an angle
chi; ; modulus of elliptic integrals; -; elliptic
E_at_chi; elliptic_e(chi**2); complete elliptic integral of the second kind; -; elliptic
K_at_chi; elliptic_k(chi**2); complete elliptic integral of the first kind; -; elliptic
"""
"""Name, formula of the body, meaning, unit, and words without which the paper gives no reason."""
_ARGUMENTS = {"p": "x", "F": "s"}
"""The arguments of proposed formulas, if they are not c."""
_INDEX = r"_(?:[0-9AB]|asy|LHS|RHS|star)(?=_|$)"


class Proposal(NamedTuple):
    """The formula, the meaning and the unit that a draft proposes for a symbol."""

    formula: str = ""
    meaning: str = ""
    unit: str = ""


_ROWS = {
    name: (Proposal(*cells[:3]), "".join(cells[3:]))
    for name, *cells in (re.split(r"\s*;\s*", row) for row in _TABLE.strip().splitlines())
}


def proposal(name: str, text: str = "") -> Proposal:
    """Return the proposal for a name, with or without its index and arguments.

    text: the text of the paper
    """
    stem = name.partition("_at_")[0]
    known = next((each for each in (name, stem, re.sub(_INDEX, "", stem)) if each in _ROWS), "")
    found, needed = _ROWS.get(known, (Proposal(), ""))
    if needed and not re.search(needed, text, re.IGNORECASE):
        return Proposal()
    if name not in (known, f"{known}_at_{_ARGUMENTS.get(known, 'c')}"):
        found = found._replace(formula="")
    if found.unit == "rad" and known not in (name, stem):  # alpha_1 may be any quantity
        found = found._replace(unit="")
    return found
