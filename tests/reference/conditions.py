"""The two integral conditions of the exact stick zone, by quadrature.

    int_slip r/w dxi = -pi dsigma/4,    int_slip r xi/w dxi = dQ + pi dsigma (m - n)/8,

r = kappa f (p1 + p2), w = sqrt((xi + m)(xi - n)), positive right of n and negative left of -m;
kappa is 1 on the left, and on the right 1 in moderate tension and -1 in large tension.

They hold for half-cycles at whose end |q| = f p in all of both slip zones.  Whether this is so can
be checked with partial half-cycles, which satisfy the same conditions: see `Premise`.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise, product

import numpy as np
from scipy.optimize import root

from tests.reference.loads import State
from tests.reference.mesh import Floats
from tests.reference.stick import Zone

Function = Callable[[Floats], Floats]

MODERATE, LARGE = 1, -1
"""Values of kappa on the right."""

NOWHERE = Zone(np.nan, np.nan)

EXACT = 1e-9
"""Largest residual of the conditions, relative to dQ or to the corresponding measure of tension."""

STARTS = (0.8, 0.6, 0.4, 0.99)
"""Starting values of m and n in the search for a zone, relative to the contact common to both ends
of the half-cycle."""

PARTS = np.sin(np.linspace(np.pi / 2, 0, 24, endpoint=False)[1:]) ** 2
"""Fractions of a half-cycle at which its premise is checked, from its end to its beginning."""

PLACES = np.linspace(0, 1, 9)[:-1] ** 2
"""Points at which it is checked, as fractions of the region that has yet to slip, from its inner
end outwards."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(160)


@dataclass(frozen=True)
class Patch:
    """A contact [-a, c], and the pressure inside it."""

    a: float
    c: float
    inside: Function

    def p(self, x: Floats) -> Floats:
        """Pressure at the points x."""
        p, within = np.zeros_like(x), (x > -self.a) & (x < self.c)
        p[within] = self.inside(x[within])
        return p


@dataclass(frozen=True)
class HalfCycle:
    """Loads that vary linearly from one state to another; `patch(P, M)` is the contact."""

    patch: Callable[[float, float], Patch]
    f: float
    first: State
    second: State

    @property
    def dQ(self) -> float:
        """Change of the shear load."""
        return self.second.Q - self.first.Q

    @property
    def dsigma(self) -> float:
        """Change of the differential bulk tension."""
        return self.second.sigma - self.first.sigma

    @property
    def ends(self) -> tuple[Patch, Patch]:
        """Contacts at the beginning and at the end."""
        return self.patch(self.first.P, self.first.M), self.patch(self.second.P, self.second.M)

    def partial(self, part: float) -> "HalfCycle":
        """The half-cycle up to a given fraction of it."""
        return replace(self, second=self.first.towards(self.second, part))

    def back(self) -> "HalfCycle":
        """The half-cycle from the second state to the first, with shear and slip reversed."""
        turned = [s._replace(Q=-s.Q, sigma=-s.sigma) for s in (self.second, self.first)]
        return replace(self, first=turned[0], second=turned[1])

    @property
    def always(self) -> Zone:
        """The zone that is in contact at both ends."""
        first, second = self.ends
        return Zone(min(first.a, second.a), min(first.c, second.c))

    def slip(self, zone: Zone, kappa: int) -> "Slip":
        """The change r of shear on both sides of a stick zone."""
        first, second = self.ends

        def r(x: Floats) -> Floats:
            return self.f * (first.p(x) + second.p(x))

        edges = (-first.a, -second.a), (first.c, second.c)
        return Slip(zone, *edges, r, lambda x: kappa * r(x))

    def exact(self, kappa: int) -> Zone:
        """The zone that satisfies the conditions; NaN if none is found from any start."""
        m, n = self.always
        zones = (self.zone(kappa, Zone(u * m, v * n)) for u, v in product(STARTS, STARTS))
        return next((zone for zone in zones if not np.isnan(zone.m)), NOWHERE)

    def zone(self, kappa: int, guess: Zone) -> Zone:
        """A zone near a guess that satisfies the conditions inside both contacts; NaN if none."""

        def missing(z: Floats) -> tuple[float, float]:
            return self.slip(Zone(*z), kappa).missing(self.dQ, self.dsigma)

        found = root(missing, guess, tol=1e-13)
        zone, always = Zone(*map(float, found.x)), self.always
        within = -zone.m < zone.n <= always.n and zone.m <= always.m
        scale = max(abs(self.dQ), np.pi * abs(self.dsigma) * (always.m + always.n) / 8)
        return zone if within and np.abs(found.fun).max() <= EXACT * scale else NOWHERE


@dataclass(frozen=True)
class Slip:
    """A stick zone, and the change r of shear outside it.

    left, right: points at which r varies like a square root.
    """

    zone: Zone
    left: tuple[float, ...]
    right: tuple[float, ...]
    r_left: Function
    r_right: Function

    def missing(self, dQ: float, dsigma: float) -> tuple[float, float]:
        """Residuals of the conditions: left-hand sides minus right-hand sides."""
        m, n = self.zone
        return (
            self._over(lambda x: np.sign(x - n)) + np.pi * dsigma / 4,
            self._over(lambda x: np.sign(x - n) * x) - dQ - np.pi * dsigma * (m - n) / 8,
        )

    def shear(self, x: float) -> float:
        """Change of shear at x in the stick zone.

        dq(x) = (1/pi) sqrt((x + m)(n - x)) int_slip r / |w (xi - x)| dxi
        """
        m, n = self.zone
        around = self._over(lambda xi: 1 / np.abs(xi - x))
        return float(np.sqrt(max((x + m) * (n - x), 0.0)) / np.pi * around)

    def _over(self, weight: Function) -> float:
        """int_slip r weight/|w| dxi."""
        m, n = self.zone
        left = _side(lambda x: self.r_left(x) * weight(x), -m, n, self.left)
        return left + _side(lambda x: self.r_right(x) * weight(x), n, -m, self.right)


def _side(integrand: Function, end: float, other: float, cuts: tuple[float, ...]) -> float:
    """int integrand/|w| dxi from the end of the stick zone to the farthest cut, piece by piece."""
    places = sorted({end, *cuts}, key=lambda cut: abs(cut - end))
    return sum(_piece(integrand, end, other, *ends) for ends in pairwise(places))


def _piece(integrand: Function, end: float, other: float, start: float, stop: float) -> float:
    """The integral over one piece; xi = start + (stop - start) sin^2(t) removes square roots."""
    t = np.pi / 4 * (1 + NODES)
    away = (stop - start) * np.sin(t) ** 2
    x = start + away
    w = np.sqrt(np.abs((start - end + away) * (x - other)))
    return float(np.pi / 4 * WEIGHTS @ (integrand(x) / w * abs(stop - start) * np.sin(2 * t)))


class Premise(Enum):
    """Whether the partial half-cycles justify the conditions for the whole one."""

    HOLDS = "holds"
    NO_ZONE = "no zone inside both contacts"
    SHRINKS = "a slip zone shrinks"
    BEYOND = "shear beyond friction"


def premise(half: HalfCycle, kappa: int, zone: Zone) -> Premise:
    """Whether the premise of the conditions holds in this half-cycle.

    It holds under two requirements.  Both slip zones grow throughout the half-cycle, inside both
    contacts.  Where slip has yet to begin, the shear traction, which starts at the friction bound,
    stays within it: kappa dq >= f (p1 - p).  The second one is most critical at the beginning of
    the half-cycle, which `starts_within` checks separately, and at the inner end of the region that
    has yet to slip.
    """
    if np.isnan(zone.m):
        return Premise.NO_ZONE
    if not starts_within(half, kappa, zone):
        return Premise.BEYOND
    wider = zone
    for part in PARTS:
        gone = half.partial(float(part))
        before, wider = wider, gone.zone(kappa, wider)
        if np.isnan(wider.m) or wider.m < before.m or wider.n < before.n:
            return Premise.SHRINKS
        if _beyond(gone, kappa, zone, wider):
            return Premise.BEYOND
    return Premise.HOLDS


def starts_within(half: HalfCycle, kappa: int, zone: Zone) -> bool:
    """Whether |q| falls below f p at the beginning of a half-cycle: kappa dq' >= -f dp'.

    The whole contact sticks for an instant.  Both rates, at a distance s from the middle of
    [-a, c], are those of a flat punch:

        dq' = (dQ - (pi/4) dsigma s)/(pi w),    dp' = (dP - 8 (dM + d dP) s/h^2)/(pi w),

    with w = sqrt(h^2/4 - s^2), d the position of the middle and int p x dx = -M.  Both are linear
    in s apart from 1/w, so that it suffices to check the ends of the region that has yet to slip.
    """
    first, second = half.first, half.second
    contact, _ = half.ends
    h, middle = contact.a + contact.c, (contact.c - contact.a) / 2
    dP, dM = second.P - first.P, second.M - first.M
    for sense, inner, outer in ((1, -zone.m, -contact.a), (kappa, zone.n, contact.c)):
        s = np.array([inner, outer]) - middle
        shear = half.dQ - np.pi * half.dsigma / 4 * s
        pressure = dP - 8 * (dM + middle * dP) * s / h**2
        if np.any(sense * shear < -half.f * pressure):
            return False
    return True


def _beyond(gone: HalfCycle, kappa: int, zone: Zone, wider: Zone) -> bool:
    """Whether |q| exceeds f p between the final stick zone and the wider one at this stage."""
    first, now = gone.ends
    slip = gone.slip(wider, kappa)
    for sense, inner, outer in ((1, -zone.m, -wider.m), (kappa, zone.n, wider.n)):
        x = inner + (outer - inner) * PLACES
        least = gone.f * (first.p(x) - now.p(x))
        change = np.array([slip.shear(place) for place in x])
        if np.any(sense * change < least - EXACT * gone.f * first.p(x)):
            return True
    return False


def hertz(P: float, M: float, R: float = 1.0, E_star: float = 1.0) -> Patch:
    """p = (E*/2R) sqrt((a + x)(c - x)), half-width^2 = 4 P R/(pi E*), middle -M/P."""
    half, middle = np.sqrt(4 * P * R / (np.pi * E_star)), -M / P
    a, c = float(half - middle), float(half + middle)
    return Patch(a, c, lambda x: E_star / (2 * R) * np.sqrt((a + x) * (c - x)))


def wedge(P: float, M: float, slope: float = 1.0, E_star: float = 1.0) -> Patch:
    """p = (2 E* phi/pi) asinh sqrt(min(c (a + x), a (c - x))/(|x| (a + c))).

    P = E* phi sqrt(a c) and int p x dx = P (c - a)/4.
    """
    mean, lean = P / (E_star * slope), 2 * M / P
    a = float(np.hypot(mean, lean) + lean)
    c = mean**2 / a

    def p(x: Floats) -> Floats:
        least = np.minimum(c * (a + x), a * (c - x))
        return 2 * E_star * slope / np.pi * np.arcsinh(np.sqrt(least / (np.abs(x) * (a + c))))

    return Patch(a, c, p)
