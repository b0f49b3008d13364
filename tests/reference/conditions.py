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

import numpy as np
from scipy.optimize import root

from tests.reference.loads import State
from tests.reference.mesh import Floats
from tests.reference.stick import Zone

MODERATE, LARGE = 1, -1
"""kappa on the right."""

NOWHERE = Zone(np.nan, np.nan)

EXACT = 1e-9
"""What may be missing in the conditions, over dQ."""

STARTS = (0.98, 0.8, 0.6, 0.4)
"""Parts of what is in contact at both ends, from which a zone is searched for."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(160)


@dataclass(frozen=True)
class Patch:
    """A contact [-a, c], and the pressure inside it."""

    a: float
    c: float
    inside: Callable[[Floats], Floats]

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

    def missing(self, zone: Zone, kappa: int) -> tuple[float, float]:
        """Left sides less right sides."""
        sides = self._sides(zone)
        force, moment = (
            kappa * sides[1].integral(weighted) - sides[0].integral(weighted)
            for weighted in (self._r, lambda x: self._r(x) * x)
        )
        return (
            force + np.pi * self.dsigma / 4,
            moment - self.dQ - np.pi * self.dsigma * (zone.m - zone.n) / 8,
        )

    def exact(self, kappa: int) -> Zone:
        """What meets the conditions, searched for from the edges inwards; NaN if nothing does."""
        m, n = self.always
        zones = (self.zone(kappa, Zone(part * m, part * n)) for part in STARTS)
        return next((zone for zone in zones if not np.isnan(zone.m)), NOWHERE)

    def zone(self, kappa: int, guess: Zone) -> Zone:
        """What meets the conditions near a guess, inside both contacts; NaN if nothing does."""
        found = root(lambda z: self.missing(Zone(*z), kappa), guess, tol=1e-13)
        zone, always = Zone(*map(float, found.x)), self.always
        within = -zone.m < zone.n <= always.n and zone.m <= always.m
        return zone if within and np.abs(found.fun).max() <= EXACT * self.dQ else NOWHERE

    def shear(self, zone: Zone, kappa: int, x: float) -> float:
        """Change of shear at x in the stick zone.

        dq(x) = (1/pi) sqrt((x + m)(n - x)) int_slip r / |w (xi - x)| dxi
        """
        left, right = self._sides(zone)
        around = left.integral(lambda xi: self._r(xi) / (x - xi)) + kappa * right.integral(
            lambda xi: self._r(xi) / (xi - x)
        )
        return float(np.sqrt((x + zone.m) * (zone.n - x)) / np.pi * around)

    def _r(self, x: Floats) -> Floats:
        """f (p1 + p2)."""
        first, second = self.ends
        return self.f * (first.p(x) + second.p(x))

    def _sides(self, zone: Zone) -> tuple["_Side", "_Side"]:
        first, second = self.ends
        return (
            _Side(-zone.m, zone.n, (-first.a, -second.a)),
            _Side(zone.n, -zone.m, (first.c, second.c)),
        )


class Premise(Enum):
    """What partial half-cycles say about the whole one."""

    HOLDS = "holds"
    NO_ZONE = "no zone inside both contacts"
    SHRINKS = "a slip zone shrinks"
    BEYOND = "shear beyond friction"


def premise(half: HalfCycle, kappa: int, zone: Zone, count: int = 16) -> Premise:
    """Whether this half-cycle may pass through its partial ones.

    Both slip zones must grow with the part that is gone, inside both contacts; and where slip is
    still to come, the shear, which begins at friction, must stay within it:
    kappa dq >= f (p1 - p) there.
    """
    if np.isnan(zone.m):
        return Premise.NO_ZONE
    wider = zone
    for part in np.linspace(1, 0, count, endpoint=False)[1:]:
        gone = half.partial(float(part))
        before, wider = wider, gone.zone(kappa, wider)
        if np.isnan(wider.m) or wider.m < before.m or wider.n < before.n:
            return Premise.SHRINKS
        if _beyond(gone, kappa, zone, wider):
            return Premise.BEYOND
    return Premise.HOLDS


def _beyond(gone: HalfCycle, kappa: int, zone: Zone, wider: Zone, count: int = 8) -> bool:
    """Whether shear passes friction between the whole's stick zone and the wider one so far."""
    first, now = gone.ends
    for sense, inner, outer in ((1, -zone.m, -wider.m), (kappa, zone.n, wider.n)):
        x = inner + (outer - inner) * (np.arange(count) + 0.5) / count
        least = gone.f * (first.p(x) - now.p(x))
        change = np.array([gone.shear(wider, kappa, place) for place in x])
        if np.any(sense * change < least - EXACT * gone.f * first.p(x)):
            return True
    return False


@dataclass(frozen=True)
class _Side:
    """The slip zone from an end of the stick zone, the other end of which is `other`."""

    end: float
    other: float
    edges: tuple[float, float]

    def integral(self, r: Callable[[Floats], Floats]) -> float:
        """int r/|w| dxi to the farther edge, cut at the nearer one."""
        near, far = sorted(self.edges, key=lambda edge: abs(edge - self.end))
        return self._piece(r, self.end, near) + self._piece(r, near, far)

    def _piece(self, r: Callable[[Floats], Floats], start: float, stop: float) -> float:
        """xi = start + (stop - start) sin^2(t) takes away the roots at both ends."""
        if start == stop:
            return 0.0
        t = np.pi / 4 * (1 + NODES)
        away = (stop - start) * np.sin(t) ** 2
        x = start + away
        w = np.sqrt(np.abs((start - self.end + away) * (x - self.other)))
        integrand = r(x) * abs(stop - start) * np.sin(2 * t) / w
        return float(np.pi / 4 * WEIGHTS @ integrand)


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
