"""Constant normal loads, if slip reverses within the half-cycle: the exact stick zone.

While [-m, n] sticks and the loads change in proportion to lambda, the shear traction changes by

    dq/dlambda ~ (dQ/pi - (dsigma/4) (m + n)/2) / sqrt((x + m)(n - x)),    dQ, dsigma > 0,

Hence the right edge slips as in large tension as long as m + n > H = 8 dQ/(pi dsigma).  The left
slip zone grows throughout the half-cycle, so that m + n falls.  A half-cycle has three phases:

1. [-m, n] shrinks from both edges, as in large tension, until m + n = H.  Then n is smallest.
2. The right side sticks again, from n outwards.  At the new end of the stick zone the rate of q is
   bounded, so that m + n = H remains, and

       dq/dlambda = (dsigma/4) sqrt((n - x)/(x + m)).

   The rate Lambda = -dlambda/dm follows from q = f p at -m, which is Abel's equation:

       (dsigma/4) int_m^{m1} sqrt((H - t)/t) Lambda(mu) dmu = 2 f p(-m) - dq1(-m),    t = mu - m,

   where m1 and dq1 are the values at the end of phase 1.
3. The whole right side sticks, m + c = H.  From then on it slips as in moderate tension.

The two half-cycles are mirror images, so that the shear traction at the start of one is minus that
at its end.  Hence the change on the right in phase 1 is -2 f p + gain.  The gain is the change of
shear since the point stuck again, and is 2 f p where phase 3 has brought q to f p.  It is found by
iteration.

At lower tension m + n never exceeds H once slip has begun; at higher tension m + n exceeds H until
the end.  The window of tensions is thus given by 8 dQ/(pi dsigma) < a + n(moderate) and
m + n(large) < 8 dQ/(pi dsigma).
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, root

from tests.reference.conditions import EXACT, Function, HalfCycle, Slip
from tests.reference.mesh import Floats, graded
from tests.reference.stick import Zone

CELLS = 200
"""Number of steps of phase 2."""

APART = np.sort(np.append(1 - np.geomspace(1e-6, 1e-2, 60), np.linspace(1e-6, 0.99, 40)))
"""Points, relative to the available interval, between which a change of sign is sought."""

REST = 1e-10
"""The iteration has converged if n* over c changes by less than this."""


class Turning(NamedTuple):
    """The permanent zone; fractions of the half-cycle at which phases 1 and 2 end; n of phase 3."""

    zone: Zone
    first: float
    second: float
    n_end: float


class NotInWindow(ValueError):
    """Slip does not reverse, or not in the assumed phases."""


@dataclass(frozen=True)
class Gain:
    """Change of shear on the right since it stuck again; a table up to n_end, then `beyond`."""

    n_end: float
    table: Function
    beyond: Function

    def __call__(self, x: Floats) -> Floats:
        """The gain at the points x; to the left of n* as at n*."""
        return np.where(x < self.n_end, self.table(np.minimum(x, self.n_end)), self.beyond(x))


def turning(
    half: HalfCycle, rounds: int = 30, breaks: tuple[float, ...] = (), cells: int = CELLS
) -> Turning:
    """The steady cycle at constant normal loads in which slip reverses on the right.

    breaks: points where the formula of the pressure changes; integrals are split there.
    """
    window = _Window(half, breaks, cells)
    gain = Gain(window.c, lambda x: window.twice(x) / 2, window.twice)
    before = np.nan
    for _ in range(rounds):
        grown, part = window.grow(gain)
        if part >= 1:
            raise NotInWindow("slip does not reverse before the end of the half-cycle")
        receded = window.recede(grown, part)
        end, gain = window.turn(grown, receded)
        if abs(grown.zone.n - before) < REST * window.c:
            return Turning(Zone(end.m, grown.zone.n), part, float(receded.parts[-1]), end.n)
        before = grown.zone.n
    raise NotInWindow("the iteration for the gain does not converge")


@dataclass(frozen=True)
class _Receding:
    """Phase 2: m, the fraction of the half-cycle at each m, and Lambda between them."""

    width: float
    dsigma: float
    m: Floats
    parts: Floats
    rates: Floats

    def gain(self, x: Floats) -> Floats:
        """int dq/dlambda Lambda dmu while x sticks: mu < H - x."""
        mu = np.minimum(self.m, (self.width - x)[:, None]) + x[:, None]
        return self.dsigma / 4 * (-np.diff(_kernel(mu, self.width), axis=1)) @ self.rates


def _kernel(t: Floats, width: float) -> Floats:
    """int_0^t sqrt((H - t)/t) dt, by t = H sin^2(phi)."""
    phi = np.arcsin(np.sqrt(np.clip(t / width, 0, 1)))
    return width * (phi + np.sin(phi) * np.cos(phi))


@dataclass(frozen=True)
class _Window:
    half: HalfCycle
    breaks: tuple[float, ...] = ()
    cells: int = CELLS

    @property
    def a(self) -> float:
        return self.half.ends[0].a

    @property
    def c(self) -> float:
        return self.half.ends[0].c

    @property
    def width(self) -> float:
        """H."""
        return 8 * self.half.dQ / (np.pi * self.half.dsigma)

    @property
    def places(self) -> int:
        """Elements of a table."""
        return 3 * self.cells // 10

    def twice(self, x: Floats) -> Floats:
        """2 f p."""
        return 2 * self.half.f * self.half.ends[0].p(x)

    def beside(self, zone: Zone, left: float, cuts: tuple[float, ...], *r: Function) -> Slip:
        """Slip on the left from -left, and on the right up to c; split at the cuts and breaks."""
        lefts = (x for x in self.breaks if -left < x < -zone.m)
        rights = (x for x in (*cuts, *self.breaks) if zone.n < x < self.c)
        return Slip(zone, (-left, *lefts), (*rights, self.c), *r)

    def grow(self, gain: Gain) -> tuple[Slip, float]:
        """Phase 1: the slip at its end, and the fraction of the half-cycle at that time.

        With m = H - n, the two conditions determine n and the fraction, in which they are linear.
        """

        def slip(n: float) -> Slip:
            zone, r = Zone(self.width - n, n), lambda x: gain(x) - self.twice(x)
            return self.beside(zone, self.a, (gain.n_end,), self.twice, r)

        def missing(n: float) -> float:
            force, moment = slip(n).missing(0.0, 0.0)
            per_part = slip(n).missing(self.half.dQ, self.half.dsigma)
            return force * (per_part[1] - moment) - moment * (per_part[0] - force)

        least = self.width - self.a  # m = a
        n = _root(missing, least + (self.c - least) * APART)
        return slip(n), -4 * slip(n).missing(0.0, 0.0)[0] / (np.pi * self.half.dsigma)

    def recede(self, grown: Slip, part: float) -> _Receding:
        """Phase 2, until the whole right side sticks or the half-cycle ends."""
        H, dsigma = self.width, self.half.dsigma
        m = np.linspace(grown.zone.m, H - self.c, self.cells + 1)
        missing = self.twice(-m[1:]) - [grown.shear(-place) for place in m[1:]]
        rates = np.zeros(self.cells)
        for i in range(self.cells):
            weights = -dsigma / 4 * np.diff(_kernel(m[: i + 2] - m[i + 1], H))
            rates[i] = (missing[i] - weights[:-1] @ rates[:i]) / weights[-1]
        parts = part + np.append(0, np.cumsum(rates * -np.diff(m)))
        gone = int(np.count_nonzero(parts < 1))
        if gone <= self.cells:  # the half-cycle ends first
            last = float(np.interp(1.0, parts, m))
            m, parts, rates = np.append(m[:gone], last), np.append(parts[:gone], 1.0), rates[:gone]
        return _Receding(H, dsigma, m, parts, rates)

    def turn(self, grown: Slip, receded: _Receding) -> tuple[Zone, Gain]:
        """The zone at the end of the half-cycle and the whole gain; phase 3 if it occurs."""
        n1, m = grown.zone.n, float(receded.m[-1])
        left = 1 - float(receded.parts[-1])
        if left <= 0:
            end = Zone(m, self.width - m)
            x = graded([n1, end.n], self.places)
            return end, Gain(end.n, _tabled(x, receded.gain(x)), np.zeros_like)
        slip = self._third(grown, receded, left)
        n = slip.zone.n
        # after convergence, n1 is less than n
        x = graded([n1 if n1 < n else 2 * n - self.c, n], self.places)
        won = receded.gain(x[:-1]) + [slip.shear(place) for place in x[:-1]]
        table = _tabled(x, np.append(won, self.twice(x[-1:])))
        return slip.zone, Gain(n, table, self.twice)

    def _third(self, grown: Slip, receded: _Receding, left: float) -> Slip:
        """The slip of phase 3, by the conditions for the remaining change of the loads."""
        m3, n1 = float(receded.m[-1]), grown.zone.n
        dQ, dsigma = left * self.half.dQ, left * self.half.dsigma
        x = m3 * (np.linspace(0, 1, 2 * self.places) ** 2 / 2 - 1)
        lacking = _tabled(x, self.twice(x) - receded.gain(x) - [grown.shear(at) for at in x])
        y = graded([n1, self.c], self.places)
        won = _tabled(y, receded.gain(y))

        def slip(zone: Zone) -> Slip:
            return self.beside(zone, m3, (), lacking, lambda x: self.twice(x) - won(x))

        near = (1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5)
        for u, v in product(near, near):
            start = Zone(m3 - u * m3 / 4, self.c - v * (self.c - n1))
            found = root(lambda z: slip(Zone(*z)).missing(dQ, dsigma), start, tol=1e-12)
            zone = Zone(*map(float, found.x))
            if np.abs(found.fun).max() < EXACT * dQ and -zone.n < zone.m <= m3 and zone.n < self.c:
                return slip(zone)
        raise NotInWindow("no solution for phase 3: the right side does not slip again")


def _tabled(x: Floats, values: Floats) -> Function:
    """Interpolation between the points x, constant beyond them."""
    table = PchipInterpolator(x, values)
    return lambda place: table(np.clip(place, x[0], x[-1]))


def _root(f: Callable[[float], float], places: Floats) -> float:
    """The largest root between the points."""
    signs = np.sign([f(place) for place in places])
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    if not len(changes):
        raise NotInWindow("slip at the right edge does not reverse")
    last = changes[-1]
    return float(brentq(f, places[last], places[last + 1], xtol=1e-14))
