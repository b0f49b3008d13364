"""The two integral conditions of the exact stick zone, by quadrature.

    int_slip r/w dxi = -pi dsigma/4,    int_slip r xi/w dxi = dQ + pi dsigma (m - n)/8,

r = kappa f (p1 + p2), w = sqrt((xi + m)(xi - n)), positive right of n and negative left of -m;
kappa is 1 on the left, and on the right 1 in moderate tension and -1 in large tension.  They hold
where slip grows all through every half-cycle.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

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
    def start(self) -> Zone:
        """Where to search from."""
        ends = self.ends
        return Zone(*(0.8 * min(edges) for edges in zip(*((e.a, e.c) for e in ends), strict=True)))

    def missing(self, zone: Zone, kappa: int) -> tuple[float, float]:
        """Left sides less right sides."""
        ends = self.ends
        sides = (
            (_Side(-zone.m, zone.n, (-ends[0].a, -ends[1].a)), -1),
            (_Side(zone.n, -zone.m, (ends[0].c, ends[1].c)), kappa),
        )

        def over_slip(power: int) -> float:
            def r(x: Floats) -> Floats:
                return self.f * (ends[0].p(x) + ends[1].p(x)) * x**power

            return sum(sign * side.integral(r) for side, sign in sides)

        return (
            over_slip(0) + np.pi * self.dsigma / 4,
            over_slip(1) - self.dQ - np.pi * self.dsigma * (zone.m - zone.n) / 8,
        )

    def zone(self, kappa: int, guess: Zone) -> Zone:
        """What meets the conditions inside both contacts; NaN if nothing does."""
        found = root(lambda z: self.missing(Zone(*z), kappa), guess, tol=1e-13)
        zone = Zone(*map(float, found.x))
        within = all(-patch.a <= -zone.m < zone.n <= patch.c for patch in self.ends)
        return zone if within and np.abs(found.fun).max() <= EXACT * self.dQ else NOWHERE

    def partial_zones(self, kappa: int, guess: Zone, count: int = 12) -> Iterator[Zone]:
        """The zones of partial half-cycles, from the whole one down to a small part."""
        for part in np.linspace(1, 0, count, endpoint=False):
            guess = self.partial(float(part)).zone(kappa, guess)
            yield guess

    def monotone(self, kappa: int, guess: Zone) -> bool:
        """Whether both slip zones grow all through this half-cycle."""
        falls = np.diff([*self.partial_zones(kappa, guess)], axis=0)
        return bool(np.all(falls >= 0))  # NaN is not


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
