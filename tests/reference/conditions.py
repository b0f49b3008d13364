"""The two integral conditions of the exact stick zone, by quadrature.

    int_slip r/w dxi = -pi dsigma/4,    int_slip r xi/w dxi = dQ + pi dsigma (m - n)/8,

r = kappa f (p1 + p2), w = sqrt((xi + m)(xi - n)), positive right of n and negative left of -m;
kappa is 1 on the left, and on the right 1 in moderate tension and -1 in large tension.

They hold for whole half-cycles that end with all of both slip zones at friction.  Whether they do
can be asked of the partial half-cycles, which meet the same conditions: see `Premise`.
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
"""kappa on the right."""

NOWHERE = Zone(np.nan, np.nan)

EXACT = 1e-9
"""What may be missing in the conditions, over dQ or what tension makes of it."""

STARTS = (0.8, 0.6, 0.4, 0.99)
"""Parts of what is in contact at both ends, from which a zone is searched for."""

PARTS = np.sin(np.linspace(np.pi / 2, 0, 24, endpoint=False)[1:]) ** 2
"""Parts of a half-cycle at which its premise is asked, from the whole to its beginning."""

PLACES = np.linspace(0, 1, 9)[:-1] ** 2
"""Where, from the inner end of what is still to slip outwards."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(160)


@dataclass(frozen=True)
class Patch:
    """A contact [-a, c], and the pressure inside it."""

    a: float
    c: float
    inside: Function

    def p(self, x: Floats) -> Floats:
        """Pressure at the places x."""
        p, within = np.zeros_like(x), (x > -self.a) & (x < self.c)
        p[within] = self.inside(x[within])
        return p


@dataclass(frozen=True)
class HalfCycle:
    """Loads that go straight from one state to another; `patch(P, M)` is the contact."""

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
        """Contacts before and after."""
        return self.patch(self.first.P, self.first.M), self.patch(self.second.P, self.second.M)

    def partial(self, part: float) -> "HalfCycle":
        """The same, gone a part of the way."""
        return replace(self, second=self.first.towards(self.second, part))

    def back(self) -> "HalfCycle":
        """From the second state to the first, seen with shear and slip turned round."""
        turned = [s._replace(Q=-s.Q, sigma=-s.sigma) for s in (self.second, self.first)]
        return replace(self, first=turned[0], second=turned[1])

    @property
    def always(self) -> Zone:
        """What is in contact at both ends."""
        first, second = self.ends
        return Zone(min(first.a, second.a), min(first.c, second.c))

    def slip(self, zone: Zone, kappa: int) -> "Slip":
        """What changes outside a stick zone: r on both sides of it."""
        first, second = self.ends

        def r(x: Floats) -> Floats:
            return self.f * (first.p(x) + second.p(x))

        edges = (-first.a, -second.a), (first.c, second.c)
        return Slip(zone, *edges, r, lambda x: kappa * r(x))

    def exact(self, kappa: int) -> Zone:
        """What meets the conditions, searched for from the edges inwards; NaN if nothing does."""
        m, n = self.always
        zones = (self.zone(kappa, Zone(u * m, v * n)) for u, v in product(STARTS, STARTS))
        return next((zone for zone in zones if not np.isnan(zone.m)), NOWHERE)

    def zone(self, kappa: int, guess: Zone) -> Zone:
        """What meets the conditions near a guess, inside both contacts; NaN if nothing does."""

        def missing(z: Floats) -> tuple[float, float]:
            return self.slip(Zone(*z), kappa).missing(self.dQ, self.dsigma)

        found = root(missing, guess, tol=1e-13)
        zone, always = Zone(*map(float, found.x)), self.always
        within = -zone.m < zone.n <= always.n and zone.m <= always.m
        scale = max(abs(self.dQ), np.pi * abs(self.dsigma) * (always.m + always.n) / 8)
        return zone if within and np.abs(found.fun).max() <= EXACT * scale else NOWHERE


@dataclass(frozen=True)
class Slip:
    """A stick zone, and the change r of shear beside it; at `left` and `right` r has roots."""

    zone: Zone
    left: tuple[float, ...]
    right: tuple[float, ...]
    r_left: Function
    r_right: Function

    def missing(self, dQ: float, dsigma: float) -> tuple[float, float]:
        """Left sides of the conditions less right sides."""
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
    """int integrand/|w| dxi from the end of the stick zone over the cuts to the farthest."""
    places = sorted({end, *cuts}, key=lambda cut: abs(cut - end))
    return sum(_piece(integrand, end, other, *ends) for ends in pairwise(places))


def _piece(integrand: Function, end: float, other: float, start: float, stop: float) -> float:
    """xi = start + (stop - start) sin^2(t) takes away the roots at both ends."""
    t = np.pi / 4 * (1 + NODES)
    away = (stop - start) * np.sin(t) ** 2
    x = start + away
    w = np.sqrt(np.abs((start - end + away) * (x - other)))
    return float(np.pi / 4 * WEIGHTS @ (integrand(x) / w * abs(stop - start) * np.sin(2 * t)))


class Premise(Enum):
    """What partial half-cycles say about the whole one."""

    HOLDS = "holds"
    NO_ZONE = "no zone inside both contacts"
    SHRINKS = "a slip zone shrinks"
    BEYOND = "shear beyond friction"


def premise(half: HalfCycle, kappa: int, zone: Zone) -> Premise:
    """Whether this half-cycle may pass through its partial ones.

    It may if both slip zones grow with the part that is gone, inside both contacts; and if, where
    slip is still to come, the shear, which begins at friction, stays within it:
    kappa dq >= f (p1 - p) there.  The least room for that is where a half-cycle begins, which
    `starts_within` asks by itself, and at the inner end of what is still to slip.
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
    """Whether shear leaves friction inwards where a half-cycle begins: kappa dq' >= -f dp'.

    All sticks for an instant, and a flat punch tells both rates, at s from the middle of [-a, c]:

        dq' = (dQ - (pi/4) dsigma s)/(pi w),    dp' = (dP - 8 (dM + d dP) s/h^2)/(pi w),

    w = sqrt(h^2/4 - s^2), d the middle, int p x dx = -M.  Over 1/w both are linear: the ends of
    what is still to slip decide.
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
    """Whether shear passes friction between the whole's stick zone and the wider one so far."""
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
