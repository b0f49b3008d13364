"""Numbers in the paper's consequences: what the generated modules give for the same states.

Loads of a wedge are in E* phi, lengths in P/(E* phi); f = 1, so that dQ = 0.3 is 0.3 f P.
"""

import tomllib

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, elliprf, elliprj

from derive.check.userfile import BUILT_IN
from generated import hertz, wedge
from notebooks.common import closing_tension

WEDGE = {"E_star": 1.0, "phi": 1.0}
SHEAR = 0.3
CLAIMS = [c for path in BUILT_IN.glob("*.toml") for c in tomllib.loads(path.read_text())["claims"]]
"""As they are written: to read their formulas would take many times as long."""


def told(label: str) -> str:
    (claim,) = (claim for claim in CLAIMS if claim["label"] == label)
    return " ".join(claim["consequence"].split())


def error(given: float, right: float) -> str:
    return f"{round(100 * (given / right - 1), 1) + 0.0:+.1f} %"


@pytest.mark.parametrize(
    "label",
    (
        *("K_T/tilted/left", "K_T/tilted/right"),
        *("section 5.4/underestimated/as corrected", "section 5.4/overestimated/as corrected"),
    ),
)
def test_slip_zones_of_a_tilted_wedge(label: str) -> None:
    """Exact; by K_T of a symmetric contact of half-width a or c, as printed; by K_T as it is."""
    here = wedge.contact_at_tilt(1.0, 0.3, **WEDGE)
    threshold = closing_tension(wedge, here, SHEAR, f=1.0, **WEDGE)[1]
    K_N = wedge.K_N(here.a, here.c, **WEDGE)
    for factor in (0, 1.5, 2):
        tension = factor * threshold
        zone = wedge.stick_zone(here, here, SHEAR, tension, f=1.0, **WEDGE)
        mended = wedge.slip_zones(here.a, here.c, SHEAR, tension, f=1.0, **WEDGE)
        sides = ((here.a, zone.m, K_N.left, 1), (here.c, zone.n, K_N.right, -1))
        for side, (edge, end, coefficient, sense) in zip(mended._fields, sides, strict=True):
            own = SHEAR / (np.pi * np.sqrt(2 * edge)) + sense * tension / 4 * np.sqrt(edge / 2)
            exact, printed = edge - end, abs(own) / coefficient
            right = getattr(mended, side)
            wanted = (
                f"{factor:g}, {side}: {exact:.4g}, {printed:.4g} ({error(printed, exact)}), "
                f"{right:.4g} ({error(right, exact)})"
            )
            assert wanted in told(label).split("; ")


def test_the_tilt_s_sign_in_a_tilted_wedge() -> None:
    """gamma = c/a = (1 - sin 27 deg)/(1 + sin 27 deg) = tan(31.5 deg)**2 at alpha = 0.3 phi."""
    here = wedge.contact_at_tilt(1.0, 0.3, **WEDGE)
    assert here.c / here.a == pytest.approx(np.tan(np.radians(31.5)) ** 2, rel=1e-13)


def test_the_bound_of_tension() -> None:
    for lean in (0, 0.3):
        here = wedge.contact_at_tilt(1.0, lean, **WEDGE)
        lower, upper = closing_tension(wedge, here, SHEAR, f=1.0, **WEDGE)
        assert (f"alpha_0 = {lean:g} phi: printed {lower:.4g}, corrected {upper:.4g}") in told(
            "inequalitywedge"
        )


def test_where_the_moderate_solution_ends() -> None:
    """Slip that reverses reaches a + n = 8 dQ/(pi dsigma) at once: until then n is further in."""
    here = wedge.contact(1.0, **WEDGE)
    upper = closing_tension(wedge, here, SHEAR, f=1.0, **WEDGE)[1]
    first = wedge.tension_threshold(here, here, SHEAR, f=1.0, **WEDGE).upper

    def room(tension: float) -> float:
        end = wedge.contact_at_tilt(1 - SHEAR / 2, -tension / 4, **WEDGE).c
        return float(8 * SHEAR / (np.pi * tension) - here.a - end)

    last = brentq(room, first, upper, xtol=1e-14)
    assert f"at {first / upper:.4g} of the threshold; from {last / upper:.4g} on," in told(
        "section 5.3/validity"
    )


@pytest.mark.parametrize("label", ["alpha", "section 4.1/M/integral"])
def test_the_sign_of_a_moment(label: str) -> None:
    here = wedge.contact(1.0, 0.25, **WEDGE)
    assert f"the contact is [-{here.a:.4g}, {here.c:.4g}]" in told(label)
    assert f"it is [-{here.c:.4g}, {here.a:.4g}]" in told(label)


@pytest.mark.parametrize("label", ["Hertz_shift_stick_zone", "eq26"])
def test_the_shift_of_a_cylinder_s_stick_zone(label: str) -> None:
    law = {"E_star": 1.0, "R": 1.0}
    here = hertz.contact(np.pi / 4, **law)  # a = R = 1
    zone = hertz.stick_zone(here, here, SHEAR * np.pi / 4, 4 * 0.05, f=1.0, **law)
    zones = f"{here.a - zone.m:.4g} a, {here.c - zone.n:.4g} a"
    assert f"the left and right slip zones are {zones}" in told(label)


def test_a_modulus_given_as_a_parameter() -> None:
    """Eq. (46) at m = 0.3 a, n = 0.6 a, written down here anew."""
    m, n = 0.3, 0.6
    chi = np.sqrt((1 - m**2) * (1 - n**2)) / ((1 + m) * (1 + n))

    def third(characteristic: float, k: float) -> float:
        forms = elliprf(0, 1 - k, 1), elliprj(0, 1 - k, 1, 1 - characteristic)
        return float(forms[0] + characteristic / 3 * forms[1])

    def strain(k: float) -> float:
        root = np.sqrt((1 + m) * (1 + n))
        plain = -2 * root * ellipe(k) + (n - m + 4) * (1 + m) / root * ellipk(k)
        third_kind = 2 * (n - m) * third((m - 1) / (m + 1), k)
        return float(plain + (third_kind + (m**2 - n**2) * third((1 - n) / (1 + m), k)) / root)

    assert f"has an error of {error(strain(chi), strain(chi**2))}" in told("eq. (46)/parameter")


def test_the_mean_of_tilts_and_the_tilt_at_mean_loads() -> None:
    tilts = wedge.contact(np.array([0.7, 1.3]), np.array([0.05, 0.5]), **WEDGE).alpha
    mean, at_mean = tilts.mean(), wedge.contact(1.0, 0.275, **WEDGE).alpha
    edges = (wedge.contact_at_tilt(1.0, tilt, **WEDGE).c for tilt in (at_mean, mean))
    assert (
        f"mean of the tilts {mean:.4g} phi, tilt at the mean loads {at_mean:.4g} phi; n differs by "
        f"{error(*edges)}"
    ) in told("section 4.1/alpha_0(M_0, P_0)")


def test_a_varying_moment() -> None:
    here = wedge.contact_at_tilt(1.0, 0.3, **WEDGE)
    tension = 2 * closing_tension(wedge, here, SHEAR, f=1.0, **WEDGE)[1]
    zone = wedge.stick_zone(here, here, SHEAR, tension, f=1.0, **WEDGE)
    assert f"m = {zone.m / here.a:.4g} a, n = {zone.n / here.c:.4g} c" in told(
        "section 5.5/no exact solution"
    )
