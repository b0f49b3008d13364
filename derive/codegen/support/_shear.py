r"""The change of shear over a half-cycle, and how far the surfaces slip.

With w(x) = sqrt((x + m)(x - n)), negative on the left, W(x) = sqrt((x + m)(n - x)), and r = kappa f
(p1 + p2) in the slip zones, the bounded solution is

    dq(x) = (W(x)/pi) int_slip r/(w(xi) (xi - x)) dxi              in the stick zone,
    (1/pi) PV int dq/(x - xi) dxi - dsigma/4
          = -(w(x)/pi) PV int_slip r/(w(xi) (xi - x)) dxi          in the slip zones.

The second is E*/2 times the rate of slip along x.  Slip is its integral from the stick zone: with y
and Y the distances of x and xi from there, to the outside,

    int_0^y sqrt(t (t + h_s))/(Y - t) dt = -sqrt(y (y + h_s)) - (2 Y + h_s) asinh sqrt(y/h_s)
        + sqrt(Y (Y + h_s)) log |(r + s)/(r - s)|,   r = sqrt(Y (y + h_s)),  s = sqrt(y (Y + h_s)),

and for Y < -h_s, the other slip zone, with |Y|, |Y + h_s| in r and s and the logarithm's sign
changed.  Under moderate tension dq is f (p1 + p2 - 2 p_s), p_s the pressure of the patch [-m, n].

The shear itself follows from its changes where the normal loads are constant.  From nothing, slip
holds f p where a half-cycle changes by 2 f p, and both obey the same linear equations: what Q and
sigma leave when they first rise is half the change under 2 Q and 2 sigma.  What they fall by after
that changes it as any half-cycle does, as long as it slips back in no other place than it slipped,
and drives none of these on.
"""

from typing import Any

import numpy as np

from ._arrays import Array, Flat, at_rows, contact_edges
from ._changes import pressure_along
from ._law import Law
from ._stick import moderate_motion, stick_zone_of, task_between
from ._types import Contact, Regime
from ._zones import Task, parts_of, solved_change, turning_place

LEVEL = 5
"""Steps of the quadrature are 2**-LEVEL: enough however close a place is to the stick zone."""

BESIDE = 1e-20
"""How far a place in the stick zone is kept from a kink, in parts of its width, or by one float."""

CANCELLED = 4.0
"""A difference of pressures so many times smaller than these has lost digits."""

ROUNDED = 1e-9
"""Ends of two stick zones that differ by less, in parts of the contact, may be the same."""

SHARED = 4
"""Places a cycle has at least, in the mean, if its pressures are to be shared."""

TOGETHER = 500
"""Elements that are computed in one piece."""


@np.errstate(all="ignore")
def shear_change_of(law: Law, /, *args: Any, **given: Array) -> Array:
    """dq at x; zero outside both contacts, NaN where the stick zone is not known."""
    cycle = _Known(law, *args, **given)
    return cycle.given.shaped(cycle.in_pieces(_Known.change))


@np.errstate(all="ignore")
def slip_range_of(law: Law, /, *args: Any, **given: Array) -> Array:
    """How far the surfaces slip at x over the half-cycle; zero where they stick."""
    cycle = _Known(law, *args, **given)
    return cycle.given.shaped(cycle.in_pieces(_Known.slip))


@np.errstate(all="ignore")
def shear_of(
    law: Law,
    x: Array,
    contact: Contact,
    Q: Array,
    sigma: Array,
    /,
    *,
    dQ: Array,
    dsigma: Array,
    **given: Array,
) -> Array:
    """q at x; zero outside the contact, NaN where a stick zone on the way is not known."""
    edges = contact_edges(contact, "contact")
    at = Flat({"x": x, **edges, "Q": Q, "sigma": sigma, "dQ": dQ, "dsigma": dsigma}, {}, {})
    x, a, c, Q, sigma, dQ, dsigma = (at.shaped(value) for value in at.values)
    here = Contact(a, c, np.nan)
    rise = _Known(law, x, here, here, 2 * Q, 2 * sigma, **given)
    fall = _Known(law, x, here, here, dQ, dsigma, **given)
    q = rise.in_pieces(_Known.change) / 2 - fall.in_pieces(_Known.change)
    known = rise.grows & fall.grows & fall.slips_within(rise)
    q = rise.given.shaped(np.where(known, q, np.nan))
    return np.where(dQ <= 2 * Q, q, np.nan)[()]


class _Known:
    """A place in a cycle whose stick zone is known; all arrays have one length."""

    def __init__(
        self,
        law: Law,
        x: Array,
        first: Contact,
        second: Contact,
        dQ: Array,
        dsigma: Array,
        /,
        *,
        f: Array,
        E_star: Array,
        **own: Array,
    ) -> None:
        edges = contact_edges(first, "first") | contact_edges(second, "second")
        values = {"x": x, **edges, "dQ": dQ, "dsigma": dsigma}
        Flat(values, {"E_star": E_star, **own}, {"f": f})  # what does not broadcast is told here
        zone = stick_zone_of(law, first, second, dQ, dsigma, f=f, E_star=E_star, **own)
        values |= {"m": zone.m, "n": zone.n, "regime": zone.regime}
        self.law, self.given = law, Flat(values, {"E_star": E_star, **own}, {"f": f})
        self.x, a_1, c_1, a_2, c_2, dQ, dsigma, self.m, self.n, self.regime, f = self.given.values
        self.constants = self.given.constants
        a, c = np.stack([a_1, a_2]), np.stack([c_1, c_2])
        cycles = a, c, dQ, dsigma, f, self.constants
        self.task = task_between(law, *cycles)
        # the same, its pressures to the last digits: to be told, and not integrated
        self.told = task_between(law._replace(integrand=law.pressure), *cycles)
        known = np.isfinite(self.m) & np.isfinite(self.n)
        self.large = known & (self.regime == Regime.LARGE)
        self.forward = known & np.isin(self.regime, (Regime.MODERATE, Regime.MIXED))

    @property
    def grows(self) -> Array:
        """Whether slip grows all the way; where it turns round, a cycle takes another way than a
        first rise."""
        return self.large | (self.regime == Regime.MODERATE) | self.still

    @property
    def still(self) -> Array:
        """Whether there is no shear at all."""
        return (self.regime == Regime.FULL_STICK) & self.task.alike

    def slips_within(self, other: "_Known") -> Array:
        """Whether it slips nowhere but where the other one does, and there in the other's sense.

        Nor does it drive any place on that slipped: see _stick.py for where the rate of shear
        changes its sign.  Under moderate tension it has one sign all over.
        """
        task, nearly = self.task, ROUNDED * self.task.width
        within = (self.m > other.m - nearly) & (self.n > other.n - nearly)
        alike = (self.regime == other.regime) & self.forward
        apart = self.large & other.large & (task.sense == other.task.sense)
        for m, n in ((task.smaller_a, task.smaller_c), (self.m, self.n)):
            turns = turning_place(task.dQ, task.dsigma, m, n)
            apart = apart & (turns > -other.m - nearly) & (turns < other.n + nearly)
        return self.still | ((alike | apart) & within)

    def in_pieces(self, of: Any) -> Array:
        """A result, so many elements at once."""
        found = np.full(self.x.shape, np.nan)
        for start in range(0, found.size, TOGETHER):
            rows = np.arange(start, min(start + TOGETHER, found.size))
            found[rows] = of(self, rows)
        return found

    def kappa(self, side: Array, rows: Array) -> Array:
        """Sense of slip on the left (side -1) or on the right (+1)."""
        return np.where(self.large[rows], -side * self.task.sense[rows], 1.0)

    def zone(self, side: int, task: Task, rows: Array) -> tuple[Array, Array, list[Array]]:
        """Where a slip zone starts, outward; how long it is; where it is to be cut."""
        end, smaller = (self.n, task.smaller_c) if side > 0 else (self.m, task.smaller_a)
        slip = smaller - end[rows]
        return *task.slip_zone(side, slip), task.cuts(side, slip)

    def change(self, rows: Array) -> Array:
        """dq at x."""
        task, held = self.task.on(rows), at_rows(rows, self.constants)
        m, n = self.m[rows], self.n[rows]
        x = self._beside_kinks(rows)
        side = np.where(x < (n - m) / 2, -1, 1)
        slips = (x >= n) | (x <= -m)
        sliding = self.kappa(side, rows) * task.f * self.told.on(rows).sum_of_pressures(x)
        stuck = sliding - 2 * task.f * self.law.pressure(x, m, n, **held)
        lost = self.forward[rows] & ~slips & (np.abs(sliding) > CANCELLED * np.abs(stuck))
        some = np.flatnonzero(lost)
        if some.size:
            stuck[some] = self._grown(rows[some], x[some], stuck[some])
        some = np.flatnonzero(self.large[rows] & ~slips)
        if some.size:
            stuck[some] = self._between(rows[some])
        known = self.large[rows] | self.forward[rows]
        found = np.where(known, np.where(slips, sliding, stuck), np.nan)
        return np.where(self.still[rows], 0.0, found)

    def _between(self, rows: Array) -> Array:
        """dq between slip zones of opposite signs.

        Of a cycle with many places their integrals are taken over the same pressures.
        """
        zones = np.stack([self.m, self.n, *self.task.a, *self.task.c, self.task.dQ])
        told = self.task.dsigma, self.task.f, *filter(np.ndim, self.constants.values())
        cycles, of = np.unique(np.vstack([zones, *told])[:, rows], axis=1, return_inverse=True)
        if SHARED * cycles.shape[1] > rows.size:
            given = self.m[rows], self.n[rows], self.x[rows]
            return solved_change(self.task.on(rows), *given, LEVEL)
        found = np.empty(rows.size)
        for number in range(cycles.shape[1]):
            some = np.flatnonzero(of.ravel() == number)
            one, places = rows[some[:1]], self.x[rows[some]][:, None]
            given = self.m[one], self.n[one], places
            found[some] = solved_change(self.task.on(one), *given, LEVEL)[:, 0]
        return found

    def _grown(self, rows: Array, x: Array, stuck: Array) -> Array:
        """dq = f (p1 + p2 - 2 p_s) where slip zones are short: what p has grown by since p_s.

        `stuck`, the difference, remains where that is not known to rounding.
        """
        task, held = self.task.on(rows), at_rows(rows, self.constants)
        ends = [Contact(a, c, np.nan) for a, c in zip(task.a, task.c, strict=True)]
        zone = self.m[rows], self.n[rows]
        (da, dc), settled = moderate_motion(
            self.law, ends[0], ends[1], task.dQ, task.dsigma, zone, f=task.f, **held
        )
        total, times = 0.0, 1
        if np.all(task.alike):
            ends, times = ends[:1], 2
        for end in ends:
            inward = da - (end.a - ends[0].a), dc - (end.c - ends[0].c)
            risen, known = pressure_along(self.law, x, (end.a, end.c), inward, held)
            total, settled = total - times * risen, settled & known
        return np.where(settled, task.f * total, stuck)

    def _beside_kinks(self, rows: Array) -> Array:
        """x, moved off a corner in the stick zone, inward: p is infinite there, dq is not."""
        x, m, n = self.x[rows], self.m[rows], self.n[rows]
        for place in self.task.kinks(rows):
            inward = np.where(place < (n - m) / 2, 1.0, -1.0)
            away = np.fmax(BESIDE * (m + n), np.spacing(np.abs(place)))
            there = (np.abs(x - place) < away) & (x > -m) & (x < n)
            x = np.where(there, place + inward * away, x)
        return x

    def slip(self, rows: Array) -> Array:
        """Slip at x."""
        task = self.task.on(rows)
        x, m, n, regime = self.x[rows], self.m[rows], self.n[rows], self.regime[rows]
        side = np.where(x < (n - m) / 2, -1, 1)
        total = np.where(side > 0, self._slipped(1, task, rows), self._slipped(-1, task, rows))
        known = (regime == Regime.MODERATE) | (regime == Regime.LARGE)  # there and not back
        sticks = ((x >= -m) & (x <= n)) | (regime == Regime.FULL_STICK)
        inside = (x >= -task.smaller_a) & (x <= task.smaller_c)
        found = np.where(sticks, 0.0, np.where(known, np.abs(total), np.nan))
        return np.where(inside & (regime > 0), found, np.nan)

    def _slipped(self, side: int, task: Task, rows: Array) -> Array:
        """The integral of the rate of slip from the stick zone to x, to one side."""
        stuck = self.m[rows] + self.n[rows]
        start, end, cuts = self.zone(side, task, rows)
        there = np.clip(side * self.x[rows] - start, 0, end)
        total = 0.0
        for y, weight in parts_of(end, [*cuts, there], LEVEL):
            force = self.kappa(side, rows) * task.sum_of_pressures(side * (start + y))
            weighted = weight * force / np.sqrt(y * (y + stuck))
            total = total + np.sum(weighted * _between(there, y, stuck), axis=0)
        start, end, cuts = self.zone(-side, task, rows)
        for y, weight in parts_of(end, cuts, LEVEL):
            force = self.kappa(-side, rows) * task.sum_of_pressures(-side * (start + y))
            weighted = weight * force / np.sqrt(y * (y + stuck))
            total = total - np.sum(weighted * _across(there, y, stuck), axis=0)
        scale = 2 * task.f / (np.pi * at_rows(rows, self.constants)["E_star"])
        return scale * total


def _between(y: Array, other: Array, stuck: Array) -> Array:
    """int_0^y sqrt(t (t + stuck))/(other - t) dt, its principal value."""
    root = np.sqrt(other * (other + stuck))
    r, s = np.sqrt(other * (y + stuck)), np.sqrt(y * (other + stuck))
    # |r - s| = stuck |other - y|/(r + s)
    logarithm = 2 * np.log(r + s) - np.log(np.maximum(stuck * np.abs(other - y), 1e-300))
    return root * logarithm - _smooth(y, other, stuck)


def _across(y: Array, beyond: Array, stuck: Array) -> Array:
    """int_0^y sqrt(t (t + stuck))/(other - t) dt, other = -stuck - beyond."""
    root = np.sqrt((stuck + beyond) * beyond)
    r, s = np.sqrt((stuck + beyond) * (y + stuck)), np.sqrt(y * beyond)
    logarithm = np.log((r + s) ** 2 / (stuck * (stuck + beyond + y)))
    return -root * logarithm - _smooth(y, -stuck - beyond, stuck)


def _smooth(y: Array, other: Array, stuck: Array) -> Array:
    return np.sqrt(y * (y + stuck)) + (2 * other + stuck) * np.arcsinh(np.sqrt(y / stuck))
