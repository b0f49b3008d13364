"""What each error does to a user's numbers; every number in these sentences is computed."""

import mpmath
from mpmath import mpf

from derive.paper import exact

_LEAN, _SHEAR = mpf("0.3"), mpf("0.3")
"""The paper's own example: alpha_0 = 0.3 phi, Delta Q = 0.3 f P_0."""


def slip_of_a_tilted_wedge() -> str:
    """Slip zones by the printed and by the right K_T against exact, without and with tension."""
    skew = exact.skewness(_LEAN)
    lines = ["tilted wedge, alpha_0 = 0.3 phi, dQ = 0.3 f P, slip zones as parts of sqrt(a c)"]
    m, n = exact.moderate(skew, _SHEAR, mpf(0))
    lines.append(_compared("no tension", skew, mpf(0), m, n))
    for factor in (mpf("1.5"), mpf(2)):
        tension = factor * exact.threshold(skew, _SHEAR)
        m, n = exact.large(skew, _SHEAR, tension)
        lines.append(_compared(f"{float(factor):g} times the threshold", skew, tension, m, n))
    return "; ".join(lines)


def _compared(case: str, skew: mpf, tension: mpf, m: mpf, n: mpf) -> str:
    true = (1 / skew - m, skew - n)
    ours = exact.leading(skew, _SHEAR, tension)
    printed = exact.leading_as_printed(skew, _SHEAR, tension)
    told = []
    for side, right, mended, given in zip(("left", "right"), true, ours, printed, strict=True):
        told.append(
            f"{side} exact {_short(right)}, as printed {_short(given)} ({_error(given, right)}), "
            f"corrected {_short(mended)} ({_error(mended, right)})"
        )
    return f"{case}: {', '.join(told)}"


def bound_of_tension() -> str:
    """The printed and the corrected bound."""
    told = []
    for lean in (mpf(0), _LEAN):
        skew = exact.skewness(lean)
        upper = exact.threshold(skew, _SHEAR)
        lower = 4 * (exact.tilt(skew) - exact.tilt(skew * (1 - _SHEAR / 2)))
        told.append(
            f"alpha_0 = {float(lean):g} phi: printed {_short(lower)}, corrected {_short(upper)}"
        )
    return (
        f"bound in f E* phi at dQ = 0.3 f P: {'; '.join(told)}; the printed number is the bound on "
        "tension of the other sign, at which the left slip zone closes"
    )


def validity_of_the_bound() -> str:
    """Where the moderate solution stops being exact, and where the paper puts it.

    Slip that reverses at the right edge reaches a + n0 = 8 dQ/(pi dsigma) at once; the moderate
    solution is exact as long as its own n lies further in.
    """
    upper = exact.threshold(mpf(1), _SHEAR)
    first = 8 * _SHEAR / (mpmath.pi * 2)

    def room(tension: mpf) -> mpf:
        _, n = exact.moderate(mpf(1), _SHEAR, tension)
        return 8 * _SHEAR / (mpmath.pi * tension) - (1 + n)

    last = mpmath.findroot(room, (first, upper), solver="anderson", tol=mpf(10) ** -20)
    return (
        "untilted wedge, dQ = 0.3 f P: slip at the right edge first reverses inside the "
        f"half-cycle at {_short(first / upper)} of the threshold; from {_short(last / upper)} on n "
        "is not that of eq. (28)"
    )


def signs_of_moment() -> str:
    """The contact under a positive moment, by either sign."""
    tilt = 2 / mpmath.pi * mpmath.atan(2 * mpf("0.25"))
    right, wrong = exact.skewness(tilt), exact.skewness(-tilt)
    return (
        "M = 0.25 P^2/(E* phi): the contact is "
        f"[-{_short(1 / right)}, {_short(right)}] P/(E* phi); with the sign of eq. (23) it is "
        f"[-{_short(1 / wrong)}, {_short(wrong)}], its mirror image, and so are its slip zones"
    )


def shift_of_stick_zone() -> str:
    """Slip zones of a cylinder by either sign of the shift."""
    half, shift = mpmath.sqrt(mpf(1) - mpf("0.3") / 2), mpf("0.05")
    return (
        "cylinder, dQ = 0.3 f P, R dsigma/(4 f E*) = 0.05 a: slip zones left, right are "
        f"{_short(1 - half + shift)} a, {_short(1 - half - shift)} a; by the printed sign they are "
        "exchanged, against eq. (32), which puts the larger K_T at the left edge"
    )


def modulus_read_as_parameter() -> str:
    """Eq. (46) at one stick zone, chi taken for k and for k**2."""
    a, m, n = mpf(1), mpf("0.3"), mpf("0.6")
    chi = mpmath.sqrt((a**2 - m**2) * (a**2 - n**2)) / ((a + m) * (a + n))
    right, wrong = _strain(a, m, n, chi**2), _strain(a, m, n, chi)
    return (
        f"m = 0.3 a, n = 0.6 a: the tension comes out {_error(wrong, right)} of its value away if "
        "chi is given to scipy.special.ellipk, which takes chi**2"
    )


def _strain(a: mpf, m: mpf, n: mpf, parameter: mpf) -> mpf:
    root = mpmath.sqrt((a + m) * (a + n))
    return (
        -2 * root * mpmath.ellipe(parameter)
        + (n - m + 4 * a) * (a + m) / root * mpmath.ellipk(parameter)
        + 2 * a * (n - m) / root * mpmath.ellippi((m - a) / (m + a), parameter)
        + (m**2 - n**2) / root * mpmath.ellippi((a - n) / (a + m), parameter)
    )


def tilt_at_mean_loads() -> str:
    """The mean of two tilts, and the tilt at the mean of the loads."""
    loads, arms = (mpf("0.7"), mpf("1.3")), (mpf("0.05"), mpf("0.5"))
    tilts = [_tilt(load, arm) for load, arm in zip(loads, arms, strict=True)]
    mean = sum(tilts) / 2
    at_mean = _tilt(sum(loads) / 2, sum(arms) / 2)
    skews = [exact.skewness(lean) for lean in (mean, at_mean)]
    return (
        "P from 0.7 to 1.3, M from 0.05 to 0.5 (E* phi = 1), dsigma = 0: mean of the tilts "
        f"{_short(mean)} phi, tilt at the mean loads {_short(at_mean)} phi; n differs by "
        f"{_error(skews[1], skews[0])}"
    )


def _tilt(load: mpf, moment: mpf) -> mpf:
    """alpha/phi under P and M, lengths in P/(E* phi)."""
    return 2 / mpmath.pi * mpmath.atan(2 * moment / load**2)


def varying_moment() -> str:
    """The paper's last example by the two conditions, and by the edge terms."""
    skew = exact.skewness(_LEAN)
    tension = 2 * exact.threshold(skew, _SHEAR)
    m, n = exact.large(skew, _SHEAR, tension)
    return (
        "at the mean tilt, alpha = 0.3 phi, the two conditions give "
        f"m = {_short(m * skew)} a, n = {_short(n / skew)} c; they take p_1 + p_2 for tilts that "
        "differ, under a premise on how slip grows that is not checked here"
    )


def _short(number: mpf) -> str:
    return str(mpmath.nstr(number, 4))


def _error(given: mpf, right: mpf) -> str:
    percent = round(float(100 * (given / right - 1)), 1)
    return f"{percent + 0.0:+.1f} %"
