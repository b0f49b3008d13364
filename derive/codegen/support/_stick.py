r"""The permanent stick zone [-m, n] of a cycle, and how the cycle slips, from a body's contact law.

Where slip happens in both half-cycles dq = kappa f (p1 + p2).  With kappa = +1 at both edges
(moderate tension) the zone is the contact patch of the same body at the mean load less dQ/(2 f) and
the mean tilt less dsigma/(4 f E*).  With opposite signs (large tension) it is solved for in
_zones.py.  Either is exact only while both slip zones grow all the way from one end of the cycle to
the other.  Let the loads change by dP and dM along the way, at a contact of width h, and let h_s be
the width of the zone that is still stuck; then slip goes on at the edges if

    kappa pull > f lead,    pull = dQ -/+ pi h_s dsigma/8,   lead = dP -/+ 4 h_s (dM + mid dP)/h**2,

the upper sign at the right edge, and as long as the zone ends inside both contacts.  `lead` says
how fast an edge runs ahead; where |pull| < f |lead| at both edges all the way there is no slip.
Shear that has not slipped yet, at friction since the last half-cycle, must stay within it while the
pressure falls: kappa dq > f (p1 - p).  Under moderate tension it does, since p exceeds the pressure
of a contact inside its own; under large tension it is asked.

This is tested at PARTS parts of the way, from both ends, lead included at the start.  With constant
loads it is tested where slip begins and where it ends.  On the way shear comes in at a rate of

    (dQ - pi dsigma (x - mid)/4)/(pi sqrt((x + m)(n - x))),    mid the middle of what sticks so far,

which changes its sign at x = mid + 4 dQ/(pi dsigma).  Under large tension that place must lie
between the slip zones to come, which are at friction since the last half-cycle: it does so all the
way if it does at both ends of it.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ._arrays import Array, Flat, at_rows, contact_edges
from ._changes import SETTLED, Way, change_along, change_between, step_for
from ._law import Law
from ._roots import around, increasing_root
from ._turning import turning_zone
from ._types import Contact, Regime, StickZone, Threshold
from ._zones import Task, bounded_change, force_rates, pulls, stick_between

STRIP, BESIDE = 2e-3, 4e-3
"""How far past its end the moderate zone is led on where tables fail, and whence, over a + c."""

PARTS = 8
"""Parts of a half-cycle at which the growth of slip is tested."""

PLACES = 4
"""Places of a slip zone to come at which its shear is compared with friction."""

LEVEL = 4
"""Steps of the quadrature for that are 2**-LEVEL."""

SLACK = 1e-6
"""What is allowed for rounding, in parts of the friction."""

ROUNDED = 4.0
"""Where load and tilt of a contact, rounded, move an edge by so many units, it is sharpened,"""

SHARPENED = 2
"""by so many of Newton's steps."""

ROUNDING = 8 * 2.0**-53
"""What rounding takes of load and tilt, some steps after one another, in parts of them."""

CANCELLED = 2.0
"""A difference so many times smaller than what it is taken of has lost digits."""

NEARLY = 1e-6
"""A step of Newton's method after which nothing is left to do, in parts of what is looked for."""

STEPS = 8
"""Its steps at most; two are common."""

NOTHING = 64 * 2.0**-52
"""A difference of two widths that is all rounding, in parts of them."""

HALVINGS = 52
"""Halvings of an interval: to the last bit of float64."""


@np.errstate(all="ignore")
def stick_zone_of(
    law: Law,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    /,
    *,
    f: Array,
    E_star: Array,
    mixed: bool = False,
    **own: Array,
) -> StickZone:
    """The stick zone of a cycle between two contacts of one body.

    mixed: solve cycles in which slip turns round, too, if their normal loads are constant.
    """
    if not isinstance(mixed, bool | np.bool_):
        raise TypeError(f"mixed must be True or False, for all cycles; got {mixed!r:.60}")
    cycle, given = _cycle(law, first, second, dQ, dsigma, f, E_star, own)
    regime = np.full(cycle.dQ.shape, Regime.NONE)
    m, n = np.full(regime.shape, np.nan), np.full(regime.shape, np.nan)

    cycle, open_ = cycle.followed(), cycle.exists
    regime[open_] = Regime.MIXED
    for code, found in (
        (Regime.SLIDING, _sliding),
        (Regime.FULL_STICK, _full_stick),
        (Regime.MODERATE, _moderate),
        (Regime.LARGE, _large),
    ):
        rows = np.flatnonzero(open_)
        if rows.size:
            here, left, right = found(cycle.on(rows))
            regime[rows[here]] = code
            m[rows], n[rows] = np.where(here, left, np.nan), np.where(here, right, np.nan)
            open_[rows[here]] = False
    rows = np.flatnonzero((regime == Regime.MIXED) & cycle.steady)
    if rows.size:
        m[rows], n[rows] = _overtaken(cycle.on(rows))
    rows = rows[np.isnan(m[rows])] if mixed else rows[:0]
    if rows.size:
        m[rows], n[rows] = _turning(cycle.on(rows))
        left = rows[np.isnan(m[rows])]
        m[left], n[left] = _led_on(cycle.on(left))
        regime[rows[np.isnan(m[rows])]] = Regime.UNSOLVED
    unsolved = (regime == Regime.LARGE) & ~np.isfinite(m)
    regime[unsolved] = Regime.UNSOLVED
    return StickZone(*(given.shaped(v) for v in (m, n, regime)))


@np.errstate(all="ignore")
def tension_threshold_of(
    law: Law,
    first: Contact,
    second: Contact,
    dQ: Array,
    /,
    *,
    f: Array,
    E_star: Array,
    **own: Array,
) -> Threshold:
    """The changes of tension between which the moderate solution is exact."""
    cycle, given = _cycle(law, first, second, dQ, 0.0, f, E_star, own)
    lower, upper = cycle.tensions_at_the_start
    good = cycle.exists & (lower <= upper) & (cycle.dQ < cycle.limit)
    lower, upper = np.where(good, lower, np.nan), np.where(good, upper, np.nan)
    rows = np.flatnonzero(good & ~cycle.steady)
    if rows.size:
        there = cycle.on(rows).followed()
        lower[rows], upper[rows] = _narrowed(there, lower[rows], upper[rows])
    return Threshold(given.shaped(lower), given.shaped(upper))


@np.errstate(all="ignore")
def closing_tension_of(
    law: Law,
    first: Contact,
    second: Contact,
    dQ: Array,
    /,
    *,
    f: Array,
    E_star: Array,
    **own: Array,
) -> Threshold:
    """The changes of tension at which the moderate solution leaves no slip zone at one edge."""
    cycle, given = _cycle(law, first, second, dQ, 0.0, f, E_star, own)
    load, tilt = cycle.patch_load, cycle.mean_tilt
    found = []
    for edge, sense in ((np.min(cycle.a, axis=0), -1), (np.min(cycle.c, axis=0), 1)):
        width = _width_under(cycle, load, edge, sense)
        leaning = law.tilt_of(*_keeping(edge, width, sense), cycle.constants)
        turned = tilt - leaning
        lost = np.abs(tilt) + np.abs(leaning) > CANCELLED * np.abs(turned)
        rows = np.flatnonzero(lost | (load > CANCELLED * cycle.dQ / (2 * cycle.f)))
        if rows.size:
            turned[rows] = _turned_by(cycle.on(rows), turned[rows], width[rows], sense)
        found.append(4 * cycle.f * cycle.constants["E_star"] * turned)
    lower, upper = (np.where(cycle.exists & (load > 0), v, np.nan) for v in found)
    return Threshold(given.shaped(lower), given.shaped(upper))


def _keeping(edge: Array, width: Array, sense: int) -> Way:
    """The contact of a width that keeps its edge on the left (-1) or right (+1)."""
    return (width - edge, edge) if sense > 0 else (edge, width - edge)


def _width_under(cycle: "_Cycle", load: Array, edge: Array, sense: int) -> Array:
    """Width of the contact under a load that keeps its edge on the left (-1) or right (+1)."""

    def excess(width: Array, rows: Array) -> tuple[Array, Array]:
        held = at_rows(rows, cycle.constants)
        a, c = _keeping(edge[rows], width, sense)
        K = cycle.law.K_N(a, c, **held)
        off = np.nan_to_num(cycle.law.load(a, c, **held)) - load[rows]
        return off, np.pi * np.sqrt(width) / 4 * (K.left if sense > 0 else K.right)

    return increasing_root(excess, *around(excess, np.max(cycle.a + cycle.c, axis=0)))


def _turned_by(cycle: "_Cycle", turned: Array, width: Array, sense: int) -> Array:
    """By how much the mean tilt exceeds that of the zone whose edge on one side is the contact's.

    `turned` is a difference of two tilts that has lost its digits, as the zone's `width` has.  How
    far the other edge draws back, or reaches out, is solved for instead, from what load and tilt
    change by as it does; where these are known no better, `turned` remains.
    """
    law, constants = cycle.law, cycle.constants
    other = cycle.c[1] < cycle.c[0] if sense > 0 else cycle.a[1] < cycle.a[0]
    a, c = (np.where(other, *edges[::-1]) for edges in (cycle.a, cycle.c))
    risen, leant = (np.where(other, -v, v) / 2 for v in cycle.risen)
    fallen = cycle.dQ / (2 * cycle.f) - risen

    back = a + c - width
    found, doubt = np.full((2, *turned.shape), np.nan)
    back = np.where(np.abs(back) > NOTHING * (a + c), back, 0.0)
    rows = np.flatnonzero(np.isfinite(fallen))
    for _ in range(STEPS):
        drawn, held = back[rows], at_rows(rows, constants)
        motion = (-drawn, 0.0 * drawn) if sense > 0 else (0.0 * drawn, -drawn)
        change = change_along(law, (a[rows], c[rows]), motion, held)
        left, right = a[rows] + motion[0], c[rows] + motion[1]
        K, root = law.K_N(left, right, **held)[0 if sense > 0 else 1], np.sqrt(left + right)
        step = (fallen[rows] + change.load) / (np.pi / 4 * root * K)
        back[rows] = drawn + step
        small = np.abs(step) <= NEARLY * np.abs(back[rows])
        found[rows] = leant[rows] - change.tilt + sense * step * K / root
        shares = np.abs(change.tilt) + _tilt_of(change.load, left + right)
        told = np.where(change.settled, 0.0, change.doubt * shares)
        doubt[rows] = np.where(small, told, np.nan)
        rows = rows[~small & np.isfinite(step)]
        if not rows.size:
            break
    better = doubt <= _doubt_of_difference(cycle, turned, width, sense)
    return np.where(better, found / constants["E_star"], turned)


def _doubt_of_difference(cycle: "_Cycle", turned: Array, width: Array, sense: int) -> Array:
    """What a difference of tilts may be off by, times E*: for rounding, and for the width."""
    edge, tilt = np.min(cycle.c if sense > 0 else cycle.a, axis=0), cycle.mean_tilt
    there = _keeping(edge, width, sense)
    missed = cycle.law.load(*there, **cycle.constants) - cycle.patch_load
    rounded = NOTHING * cycle.constants["E_star"] * (np.abs(tilt) + np.abs(tilt - turned))
    return rounded + _tilt_of(missed, width)


def _tilt_of(load: Array, width: Array) -> Array:
    """How far a load tilts a contact of which one edge rests, times E*."""
    return np.abs(load) * (4 / np.pi) / width


@np.errstate(all="ignore")
def moderate_motion(
    law: Law,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    zone: Way,
    /,
    *,
    f: Array,
    E_star: Array,
    **own: Array,
) -> tuple[Way, Array]:
    """How far the edges move from the first contact to the moderate zone (m, n), outward.

    To the last digits, where a difference of places has lost them; and whether it is known.  All
    arrays have one length.
    """
    cycle, _ = _cycle(law, first, second, dQ, dsigma, f, E_star, own)
    motion = zone[0] - cycle.a[0], zone[1] - cycle.c[0]
    motion, doubt = _stepped(cycle, motion, cycle.first)
    return motion, doubt <= SETTLED


# ---------------------------------------------------------------------- the cycle


@dataclass(frozen=True)
class _Cycle:
    """A body, two contacts, and the changes of shear and tension from the first to the second.

    a, c: edges, two rows, one a contact; all arrays have one length.
    way: a, c and tilt at every part of the way, once it is followed.
    """

    law: Law
    a: Array
    c: Array
    dQ: Array
    dsigma: Array
    f: Array
    constants: dict[str, Array]
    load: Array
    moment: Array
    tilt: Array
    way: Array

    @property
    def exists(self) -> Array:
        """Whether there is such a cycle."""
        numbers = np.isfinite(self.load).all(axis=0) & np.isfinite(self.tilt).all(axis=0)
        numbers = numbers & (self.f > 0) & np.isfinite(self.dsigma)
        return numbers & (self.dQ >= 0) & (self.dQ < np.inf)

    @property
    def steady(self) -> Array:
        """Whether the contact is the same at both ends."""
        return self.task.alike

    @property
    def risen(self) -> tuple[Array, Array]:
        """By how much load, and E* times the tilt, rise from the first contact to the second."""
        first, second = zip(self.a, self.c, strict=True)
        between = change_between(self.law, first, second, self.constants)
        load = np.where(between.settled, between.load, self.load[1] - self.load[0])
        turned = self.constants["E_star"] * (self.tilt[1] - self.tilt[0])
        return load, np.where(between.settled, between.tilt, turned)

    @property
    def first(self) -> tuple[Array, Array]:
        """Edges of the first contact."""
        return self.a[0], self.c[0]

    @property
    def moderate_gain(self) -> tuple[Array, Array]:
        """By how much load, and E* times the tilt, of the moderate zone exceed the first
        contact's."""
        load, tilt = self.risen
        return load / 2 - self.dQ / (2 * self.f), tilt / 2 - self.dsigma / (4 * self.f)

    @property
    def patch_load(self) -> Array:
        """The load of the moderate zone."""
        return (self.load[0] + self.load[1]) / 2 - self.dQ / (2 * self.f)

    @property
    def mean_tilt(self) -> Array:
        """The mean of the tilts at both ends."""
        return (self.tilt[0] + self.tilt[1]) / 2

    @property
    def limit(self) -> Array:
        """The change of shear from which on all slides."""
        return self.f * (self.load[0] + self.load[1])

    @property
    def task(self) -> Task:
        """It as the solver of large tension is told of it."""
        return task_between(self.law, self.a, self.c, self.dQ, self.dsigma, self.f, self.constants)

    def on(self, rows: Array) -> "_Cycle":
        """The same for some elements."""
        arrays = ("a", "c", "dQ", "dsigma", "f", "load", "moment", "tilt", "way")
        picked = {name: getattr(self, name)[..., rows] for name in arrays}
        return replace(self, constants=at_rows(rows, self.constants), **picked)

    def pulls(self, stuck: Array) -> tuple[Array, Array]:
        """By how much shear and tension drive slip at the left and the right edge."""
        return pulls(self.dQ, self.dsigma, stuck)

    def leads(self, stuck: Array, a: Array, c: Array) -> tuple[Array, Array]:
        """By how much the loads drive the left and the right edge of the contact [-a, c]."""
        more, turn = self.load[1] - self.load[0], self.moment[1] - self.moment[0]
        by_turning = 4 * stuck * (turn + (c - a) / 2 * more) / (a + c) ** 2
        return more + by_turning, more - by_turning

    def slips_at_the_start(self, left: Array, right: Array) -> Array:
        """Whether slip of the senses `left` and `right` begins at either end of the cycle."""
        held = True
        for a, c in zip(self.a, self.c, strict=True):
            pulls, leads = self.pulls(a + c), self.leads(a + c, a, c)
            for kappa, pull, lead in zip((left, right), pulls, leads, strict=True):
                held = held & (kappa * pull >= self.f * np.abs(lead))
        return held

    def holds_at_the_start(self, left: Array, right: Array, m: Array, n: Array) -> Array:
        """Whether shear that has not slipped yet stays within friction, from either end.

        Shear in full stick and pressure both change as a line over w; so it holds all over a slip
        zone to come if it does at its inner end, -m or n, and slip begins at its edge.
        """
        held = True
        for sense, a, c in zip((1, -1), self.a, self.c, strict=True):
            h, mid = a + c, (c - a) / 2
            at_left, at_right = self.leads(h, a, c)
            for kappa, x in ((left, -m), (right, n)):
                shear = self.dQ - np.pi * self.dsigma * (x - mid) / 4
                pressure = (at_left * (c - x) + at_right * (a + x)) / h
                held = held & (kappa * shear >= -sense * self.f * pressure)
        return held

    @property
    def tensions_at_the_start(self) -> tuple[Array, Array]:
        """Between which changes of tension both edges begin to slip forward."""
        bounds = []
        for a, c in zip(self.a, self.c, strict=True):
            leads = self.leads(a + c, a, c)
            bounds.append([8 * (self.dQ - self.f * np.abs(v)) / (np.pi * (a + c)) for v in leads])
        (left_1, right_1), (left_2, right_2) = bounds
        return -np.minimum(left_1, left_2), np.minimum(right_1, right_2)

    def followed(self) -> "_Cycle":
        """The same with the contacts on its way, where they vary."""
        rows = np.flatnonzero(~self.steady)
        if not rows.size:
            return self
        part = np.linspace(0, 1, PARTS + 1)[1:-1, None]
        P, M = (v[0, rows] + part * (v[1] - v[0])[rows] for v in (self.load, self.moment))
        way = np.full((3, PARTS + 1, self.dQ.size), np.nan)
        way[:, 1:-1, rows] = self.law.contact(P, M, **at_rows(rows, self.constants))
        way[:, [0, -1]] = self.a, self.c, self.tilt
        return replace(self, way=way)


def _cycle(
    law: Law,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    f: Array,
    E_star: Array,
    own: dict[str, Array],
) -> tuple[_Cycle, Flat]:
    edges = contact_edges(first, "first") | contact_edges(second, "second")
    values = {**edges, "dQ": dQ, "dsigma": dsigma}
    given = Flat(values, {"E_star": E_star, **own}, {"f": f})
    a_1, c_1, a_2, c_2, dQ, dsigma, f = given.values
    a, c = np.stack([a_1, a_2]), np.stack([c_1, c_2])
    constants = given.constants
    load, moment = law.load(a, c, **constants), law.moment(a, c, **constants)
    tilt, way = law.tilt_of(a, c, constants), np.empty((3, 0, dQ.size))
    return _Cycle(law, a, c, dQ, dsigma, f, constants, load, moment, tilt, way), given


# ---------------------------------------------------------------------- the regimes

Found = tuple[Array, Array, Array]
"""Whether a cycle is of a regime; m; n."""


def _sliding(cycle: _Cycle) -> Found:
    nowhere = np.full_like(cycle.dQ, np.nan)
    return ~(cycle.dQ < cycle.limit), nowhere, nowhere


def _full_stick(cycle: _Cycle) -> Found:
    """An edge that turns back on the way, lead = 0, could not bear any shear there.

    Rates of shear and of pressure are lines over w between those of the edges.  If the pressure
    rises, or falls, at both, friction at the edges is friction all over; else there is a place
    where it rests while shear goes on, and the edges tell nothing, unless there is no shear.
    """
    a, c = np.minimum(*cycle.a), np.minimum(*cycle.c)
    sticks = (cycle.dQ == 0) & (cycle.dsigma == 0)
    rows = np.flatnonzero(~cycle.steady)
    if rows.size:
        there = cycle.on(rows)
        edges = there.way[:2]
        h = edges[0] + edges[1]
        pulls, leads = there.pulls(h), there.leads(h, *edges)
        held = (leads[0] * leads[1] >= 0) | ((pulls[0] == 0) & (pulls[1] == 0))
        for pull, lead in zip(pulls, leads, strict=True):
            held = held & (np.abs(pull) <= there.f * np.abs(lead)) & (lead * lead[0] >= 0)
        sticks[rows] |= np.all(held, axis=0)
        a[rows], c[rows] = np.min(edges[0], axis=0), np.min(edges[1], axis=0)
    return sticks & (a + c > 0), a, c


def _moderate(cycle: _Cycle) -> Found:
    slips = cycle.slips_at_the_start(1, 1)
    rows = np.flatnonzero(slips & ~cycle.steady)
    if rows.size:
        slips[rows] = _grows(cycle.on(rows))
    patch = _patch(cycle, cycle.load, cycle.tilt, 1.0)
    m, n = _sharpened(cycle, patch.a, patch.c, slips & np.isfinite(patch.a))
    return slips & np.isfinite(m), m, n


def _sharpened(cycle: _Cycle, m: Array, n: Array, slips: Array) -> tuple[Array, Array]:
    """The moderate zone to its last digits, where load and tilt have not told them.

    Close to the largest tilt of a body a tilt is rounded by more than the zone bears.  There the
    changes of load and tilt from the first contact are added up instead, where they are known any
    better.
    """
    K = cycle.law.K_N(m, n, **cycle.constants)
    h, E_star = m + n, cycle.constants["E_star"]
    rounded = np.abs(cycle.load[0]) * 4 / np.pi + E_star * np.abs(cycle.tilt[0]) * h
    sizes = np.abs(cycle.a[0]), np.abs(cycle.c[0])
    lost = [rounded > ROUNDED * k * np.sqrt(h) * size for k, size in zip(K, sizes, strict=True)]
    rows = np.flatnonzero(slips & (lost[0] | lost[1]))
    if not rows.size:
        return m, n
    there, m, n = cycle.on(rows), m.copy(), n.copy()
    zone, doubt = _stepped(there, (m[rows], n[rows]), (0.0, 0.0))
    load, tilt = there.moderate_gain
    changed = np.abs(load) * 4 / np.pi + np.abs(tilt) * h[rows]
    better = doubt * changed <= ROUNDING * rounded[rows]
    m[rows], n[rows] = (np.where(better, v, w[rows]) for v, w in zip(zone, (m, n), strict=True))
    return m, n


def _stepped(cycle: _Cycle, edges: Way, origin: Way) -> tuple[Way, Array]:
    """Edges of the moderate zone after Newton's steps, and what the changes may be off by.

    They are told from the edges of an origin, as places or as motions, and keep the digits of that.
    The doubt is in parts of the changes from the first contact; infinite where there are no edges.
    """
    (left, right), (a, c) = edges, cycle.first
    doubt = np.zeros(cycle.dQ.shape)
    load, tilt = cycle.moderate_gain
    for _ in range(SHARPENED):
        motion = left + (origin[0] - a), right + (origin[1] - c)
        change = change_along(cycle.law, cycle.first, motion, cycle.constants)
        doubt = np.maximum(doubt, change.doubt)
        here = origin[0] + left, origin[1] + right
        off = load - change.load, tilt - change.tilt
        to_left, to_right = step_for(cycle.law, here, *off, cycle.constants)
        left, right = left + to_left, right + to_right
    return (left, right), np.where(np.isfinite(left + right + doubt), doubt, np.inf)


def _patch(cycle: _Cycle, loads: Any, tilts: Any, part: Array) -> Contact:
    """The stick zone of moderate tension, a part of the way from one state to another."""
    E_star = cycle.constants["E_star"]
    load = (loads[0] + loads[1]) / 2 - part * cycle.dQ / (2 * cycle.f)
    tilt = (tilts[0] + tilts[1]) / 2 - part * cycle.dsigma / (4 * cycle.f * E_star)
    return cycle.law.contact_at_tilt(load, tilt, **cycle.constants)


def _grows(cycle: _Cycle) -> Array:
    """Whether moderate slip goes on at every part of the way, from both ends."""
    a, c, tilt = cycle.way
    part = np.linspace(0, 1, PARTS + 1)[1:, None]
    grows = True
    for end, sense, there in ((0, 1, slice(1, None)), (1, -1, slice(-2, None, -1))):
        load = cycle.load[end] + sense * part * (cycle.load[1] - cycle.load[0])
        zone = _patch(cycle, (cycle.load[end], load), (tilt[-end], tilt[there]), part)
        stuck = zone.a + zone.c
        for edge, pull, lead, given in zip(
            (zone.a, zone.c),
            cycle.pulls(stuck),
            cycle.leads(stuck, a[there], c[there]),
            (a, c),
            strict=True,
        ):
            inside = (edge <= given[there]) & (edge <= given[-end])
            grows = grows & np.all(inside & (pull >= sense * cycle.f * lead), axis=0)
    return grows


def _large(cycle: _Cycle) -> Found:
    """Opposite slip at the edges: forward at the left if the tension rises."""
    sense = np.where(cycle.dsigma < 0, -1.0, 1.0)
    slips = cycle.slips_at_the_start(sense, -sense)
    m, n = np.full(sense.shape, np.nan), np.full(sense.shape, np.nan)
    rows = np.flatnonzero(slips)
    if rows.size:
        there = cycle.on(rows)
        m[rows], n[rows] = _solved(there, there.task)
        stuck = m + n
        slips &= ~(np.pi * stuck * np.abs(cycle.dsigma) / 8 < cycle.dQ)
        slips &= ~np.isfinite(m) | cycle.holds_at_the_start(sense, -sense, m, n)
    rows = np.flatnonzero(slips & ~cycle.steady & np.isfinite(m))
    if rows.size:
        slips[rows] = _grows_apart(cycle.on(rows), m[rows], n[rows])
    return slips, m, n


def _overtaken(cycle: _Cycle) -> tuple[Array, Array]:
    """m and n where slip reverses for a while at constant loads, but leaves nothing behind.

    Tension a little beyond its threshold turns slip round at one edge, say the right one.  Shear is
    at friction there already, since the last half-cycle ended so; what slips back, dq = 0, reaches
    at once as far as pull = 0, to a + n0 = 8 dQ/(pi dsigma), and sticks again at once as the left
    zone grows.  Slip that then comes in forward as under moderate tension, beyond n0, overtakes it.
    """
    patch, past = _past(cycle)
    inside = (patch.a <= cycle.a[0]) & (patch.c <= cycle.c[0])
    exact = inside & (past <= 0)
    return np.where(exact, patch.a, np.nan), np.where(exact, patch.c, np.nan)


def _past(cycle: _Cycle) -> tuple[Contact, Array]:
    """The moderate zone, and how far a + n is past 8 dQ/(pi dsigma), in parts of the contact."""
    patch = _patch(cycle, cycle.load, cycle.tilt, 1.0)
    whole = np.where(cycle.dsigma < 0, cycle.c[0] + patch.a, cycle.a[0] + patch.c)
    room = 8 * cycle.dQ / (np.pi * np.abs(cycle.dsigma))
    return patch, (whole - room) / (cycle.a[0] + cycle.c[0])


def _led_on(cycle: _Cycle) -> tuple[Array, Array]:
    """m and n a little past the end of the moderate zone, where the tables of `_turning` fail.

    n parts from the moderate one like the square of what a + n is past 8 dQ/(pi dsigma), m far
    less.  By how much is taken from a tension a little larger.
    """
    m, n = np.full((2, cycle.dQ.size), np.nan)
    past = _past(cycle)[1]
    rows = np.flatnonzero((past > 0) & (past <= STRIP))
    if rows.size:
        m[rows], n[rows] = _from_beside(cycle.on(rows))
    return m, n


def _from_beside(cycle: _Cycle) -> tuple[Array, Array]:
    patch, past = _past(cycle)
    farther = replace(cycle, dsigma=cycle.dsigma * (1 + STRIP))
    rate = (_past(farther)[1] - past) / STRIP
    beside = replace(cycle, dsigma=cycle.dsigma * (1 + (BESIDE - past) / rate))
    m, n = _turning(beside)
    there, far = _past(beside)
    share = (past / far) ** 2
    return patch.a + share * (m - there.a), patch.c + share * (n - there.c)


def _turning(cycle: _Cycle) -> tuple[Array, Array]:
    """m and n where slip turns round at constant loads; seen so that dsigma > 0.

    What sticks lies about the middle of the zone of moderate tension, or of large tension.
    """
    own, back = cycle.task, cycle.dsigma < 0
    sense = np.where(back, -1.0, 1.0)

    def pressure(x: Array, of: int, rows: Array) -> Array:
        return own.pressure(sense[rows] * x, of, rows)

    def kinks(rows: Array) -> tuple[Array, ...]:
        return tuple(sense[rows] * place for place in own.kinks(rows))

    a, c = np.where(back, own.c, own.a), np.where(back, own.a, own.c)
    seen = own._replace(a=a, c=c, dsigma=np.abs(own.dsigma), pressure=pressure, kinks=kinks)
    patch = _patch(cycle, cycle.load, cycle.tilt, 1.0)
    left, right = turning_zone(seen, sense * (patch.c - patch.a) / 2)
    rows = np.flatnonzero(np.isnan(left))
    if rows.size:
        there = cycle.on(rows)
        m, n = _solved(there, there.task)
        left[rows], right[rows] = turning_zone(seen.on(rows), sense[rows] * (n - m) / 2)
    return np.where(back, right, left), np.where(back, left, right)


def _solved(cycle: _Cycle, task: Task) -> tuple[Array, Array]:
    """m and n of large tension."""
    K = cycle.law.K_N(task.a, task.c, **cycle.constants)
    return stick_between(task, np.mean(K.left, axis=0), np.mean(K.right, axis=0))


def task_between(
    law: Law, a: Array, c: Array, dQ: Array, dsigma: Array, f: Array, constants: dict[str, Array]
) -> Task:
    """Cycles between two contacts of a body, the rows of a and c."""

    def pressure(x: Array, of: int, rows: Array) -> Array:
        return law.integrand(x, a[of][rows], c[of][rows], **at_rows(rows, constants))

    def kinks(rows: Array) -> tuple[Array, ...]:
        return law.places(at_rows(rows, constants))

    return Task(a, c, dQ, dsigma, f, np.arange(dQ.size), pressure, kinks)


def _grows_apart(cycle: _Cycle, m: Array, n: Array) -> Array:
    """Whether slip of opposite signs goes on at every part of the way, from both ends."""
    a, c, _ = cycle.way
    grows = np.full(m.shape, True)
    for end, order in ((0, range(1, PARTS)), (-1, range(PARTS - 1, 0, -1))):
        before = a[end], c[end]
        for k in order:
            part = k / PARTS if end == 0 else 1 - k / PARTS
            task = replace(
                cycle,
                a=a[[end, k]],
                c=c[[end, k]],
                dQ=part * cycle.dQ,
                dsigma=part * cycle.dsigma,
            ).task
            now = _solved(cycle, task)
            for edge, last, limit in zip(now, before, (a[k], c[k]), strict=True):
                grows &= (edge <= last) & (edge <= limit)
            grows &= _still_driven(cycle, now, a[k], c[k], 1 if end == 0 else -1)
            rows = np.flatnonzero(grows)
            now_here, whole = (tuple(v[rows] for v in zone) for zone in (now, (m, n)))
            grows[rows] &= _within_friction(task.on(rows), now_here, whole)
            before = now
        grows &= (m <= before[0]) & (n <= before[1])
        last = (a[-1], c[-1], 1) if end == 0 else (a[0], c[0], -1)
        grows &= _still_driven(cycle, (m, n), *last)
    return grows & (m <= np.minimum(*cycle.a)) & (n <= np.minimum(*cycle.c))


def _still_driven(
    cycle: _Cycle, zone: tuple[Array, Array], a: Array, c: Array, sense: int
) -> Array:
    """Whether both slip zones of large tension are growing, at a contact on the way.

    The shear that comes in with the next step, dQ, dsigma and +/- f dp in the slip zones, would
    be singular at the ends of the stick zone; it drives slip on there if it has the slip's sign.
    """
    m, n = zone
    stuck, kappa = m + n, np.where(cycle.dsigma < 0, -1.0, 1.0)
    pulls, leads = cycle.pulls(stuck), cycle.leads(a + c, a, c)
    rates = [
        force_rates(slip, stuck, a + c, own, other)
        for slip, own, other in ((a - m, *leads), (c - n, *leads[::-1]))
    ]
    (near_left, far_left), (near_right, far_right) = rates
    moving = sense * cycle.f * kappa
    left = pulls[0] - moving * (near_left - far_right)
    right = pulls[1] - moving * (far_left - near_right)
    return (kappa * left >= 0) & (kappa * right <= 0)


def _within_friction(task: Task, zone: tuple[Array, Array], whole: tuple[Array, Array]) -> Array:
    """Whether kappa dq > f (p1 - p) at places where slip is still to come.

    zone: m and n so far; whole: in the end.
    """
    within = np.full(zone[0].shape, True)
    for side, so_far, end in ((-1, zone[0], whole[0]), (1, zone[1], whole[1])):
        kappa = -side * task.sense
        for part in (np.arange(PLACES) + 0.5) / PLACES:
            x = side * (end + part * (so_far - end))
            fallen = task.pressure(x, 0, task.rows) - task.pressure(x, 1, task.rows)
            rows = np.flatnonzero(fallen > 0)
            if rows.size:
                here = task.on(rows)
                change = bounded_change(here, zone[0][rows], zone[1][rows], x[rows], LEVEL)
                least = (task.f * fallen)[rows] * (1 - SLACK)
                within[rows] &= kappa[rows] * change >= least
    return within


def _narrowed(cycle: _Cycle, lower: Array, upper: Array) -> tuple[Array, Array]:
    """The interval of tensions cut down to where moderate slip goes on to the end.

    A tension that is inside is looked for first, then each bound by halving.
    """
    inside = np.full(lower.shape, np.nan)
    for part in np.sort(np.linspace(0, 1, 2 * PARTS + 1)[1:-1], kind="stable"):
        tried = lower + part * (upper - lower)
        nearer = ~(np.abs(inside - (lower + upper) / 2) <= np.abs(tried - (lower + upper) / 2))
        inside = np.where(nearer & _grows(replace(cycle, dsigma=tried)), tried, inside)
    bounds = []
    for bound in (lower, upper):
        good, bad = np.where(_grows(replace(cycle, dsigma=bound)), bound, inside), bound
        for _ in range(HALVINGS):
            middle = (good + bad) / 2
            grows = _grows(replace(cycle, dsigma=middle))
            good, bad = np.where(grows, middle, good), np.where(grows, bad, middle)
        bounds.append(good)
    return bounds[0], bounds[1]
