"""Load histories and steady cycles: how far off they are, and how often the stated error covers it.

    python -m tests.measure.accuracy.histories [--quick]

prints a table: against finer meshes, and friction's work against that of the loads.  The tests also
compare with the independent solver and with exact zones, by functions of this module.
"""

import sys
from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from generated import catenary, flat_rounded, hertz, rounded_wedge, wedge
from generated.runtime.history import refine
from generated.runtime.types import Regime
from tests.reference.friction import Friction
from tests.reference.kernel import Surface
from tests.reference.mesh import graded
from tests.reference.normal import Body, press

F = 0.5


class Case(NamedTuple):
    """A body told twice: as a generated module, with its parameters in the module's order, and as a
    profile; a load that is at home on it."""

    module: Any
    own: dict[str, float]
    profile: Body
    load: float

    @property
    def constants(self) -> dict[str, float]:
        """What the module's functions ask for."""
        return {"f": F, "E_star": 1.0, **self.own}

    @property
    def width(self) -> float:
        """The contact's under the load alone."""
        found = self.module.contact(self.load, 0.0, E_star=1.0, **self.own)
        return float(found.a + found.c)


def _rounded(x: Any) -> Any:
    return np.where(abs(x) < 0.3, x**2 / 0.6, abs(x) - 0.15)


CASES = {
    "hertz": Case(hertz, {"R": 1.0}, Body(lambda x: x**2 / 2), np.pi / 4),
    "wedge": Case(wedge, {"phi": 1.0}, Body(np.abs, kinks=(0.0,)), 1.0),
    "flat_rounded": Case(
        flat_rounded,
        {"R": 1.0, "b": 0.5},
        Body(lambda x: np.maximum(0, abs(x) - 0.5) ** 2 / 2, kinks=(-0.5, 0.5)),
        1.0,
    ),
    "rounded_wedge": Case(
        rounded_wedge, {"b": 0.3, "phi": 1.0}, Body(_rounded, kinks=(-0.3, 0.3)), 1.0
    ),
    "catenary": Case(catenary, {"R": 1.0, "b": 1.0}, Body(lambda x: np.cosh(x) - 1), 1.0),
}


def on_elements(case: Case, loads: Any, tol: float = 1e-3, cycle: bool = False) -> Any:
    """What the solver alone says, without what is exact."""
    rows = np.array(np.broadcast_arrays(*loads), dtype=float)
    solve = refine.steady_cycle if cycle else refine.history
    return solve(case.module._BODY, case.own, F, rows, np.empty(0), tol)


# ---------------------------------------------------------------- random histories


def random_loads(case: Case, rng: Any, instants: int, varies: bool, smooth: bool) -> Any:
    """P, M, Q and sigma: legs between random instants, or sums of three waves."""
    t = np.linspace(0, 2 * np.pi, instants)

    def wave() -> Any:
        if not smooth:
            return rng.uniform(-1, 1, instants)
        parts = [rng.uniform(-1, 1) / k * np.sin(k * t + rng.uniform(0, 7)) for k in (1, 2, 3)]
        return sum(parts) / 1.8

    P = case.load * (1 + 0.3 * wave() * varies)
    M = 0.03 * P * case.width * (wave() if varies else rng.uniform(-1, 1))
    return P, M, 0.7 * F * P * wave(), 2 * F * P / case.width * wave()


class Reference(NamedTuple):
    """Nodes; at every instant q, f p and places; how far an end between two nodes may be off."""

    x: Any
    q: Any
    bound: Any
    places: Any

    def ends(self, i: int) -> tuple[float, float, bool]:
        """m and n, close to the outermost nodes that stick, and whether all between them stick:
        (f p - |q|)**2 rises from an end like a straight line."""
        q, bound, places, x = self.q[i], self.bound[i], self.places[i], self.x
        inside = np.flatnonzero((bound > 0) & (places == 0))
        if len(inside) < 6:
            return np.nan, np.nan, False
        found = []
        for last, out in ((inside[0], -1), (inside[-1], 1)):
            near, far = last - out, last - 2 * out
            g, G = (bound[[near, far]] - places[last + out] * q[[near, far]]) ** 2
            end = x[near] + (x[near] - x[far]) * g / (G - g) if g < G else x[last]
            found.append(np.clip(end, *sorted((x[last], x[last + out]))))
        return -found[0], found[1], bool(np.all(np.diff(inside) == 1))


def reference(case: Case, loads: Any, a: Any, c: Any, count: int, steps: int) -> Reference:
    """The same history by tests/reference, in even steps; the last one before an instant is short,
    since what sticks at the instant is what sticks in it."""
    places = [-a.max(), -a.min(), c.min(), c.max()]
    margin = 0.03 * (places[-1] - places[0])
    breaks = [places[0] - margin, *places, 0.0, places[-1] + margin, *case.profile.kinks]
    surface = Surface(graded(breaks, count))
    friction = Friction(surface, F, None, None, [])  # type: ignore[arg-type]
    given = np.column_stack(np.broadcast_arrays(*loads))
    q, guess, where = np.zeros_like(surface.x), None, None
    told = []
    for first, second in pairwise(np.vstack([given[:1] * [1, 1, 0, 0], given])):
        for before, part in pairwise([*np.linspace(0, 1, steps + 1)[:-1], 1 - 0.05 / steps, 1]):
            P, M, Q, _ = first + part * (second - first)
            contact = press(case.profile, surface, P, M, guess)
            guess = contact.places
            dsigma = (part - before) * (second - first)[3]
            q, _, where = friction._step(q, contact, Q, dsigma, where)
        told.append((q, F * contact.p, where))
    return Reference(surface.x, *map(np.array, zip(*told, strict=True)))


class Compared(NamedTuple):
    """Of one history: mean errors of shear over f P, those of ends over the width, the stated
    ones, whether every instant was answered."""

    shear: list[float]
    ends: list[float]
    stated: list[float]
    answered: bool


def compared(case: Case, loads: Any, count: int = 64, steps: int = 16) -> Compared:
    """A history beside the reference's."""
    plain = case.module.history(*loads, **case.constants)
    told = reference(case, loads, plain.a, plain.c, count, steps)
    found = case.module.history(*loads, x=told.x, **case.constants)
    shear, ends, stated = [], [], []
    for i, P in enumerate(np.broadcast_to(loads[0], found.m.shape)):
        shear.append(float(np.trapezoid(abs(found.q[i] - told.q[i]), told.x) / (F * P)))
        m, n, single = told.ends(i)
        if single and found.intervals[i] == 1:
            h = found.a[i] + found.c[i]
            for here, there in ((-found.m[i], -m), (found.n[i], n)):
                near = np.searchsorted(told.x, there)
                element = told.x[near] - told.x[near - 1]
                ends.append(max(abs(here - there) - element / 2, 0.0) / h)
                stated.append(float(found.error[i]))
    answered = bool(np.all(np.isfinite(found.m)) and np.all(np.isfinite(found.error)))
    return Compared(shear, ends, stated, answered)


# ---------------------------------------------------------------- closed cases


class Closed(NamedTuple):
    """A cycle in phase: load, moment, dQ over f P, dsigma; how P (over itself) and M vary."""

    body: str
    P: float
    M: float
    dQ: float
    dsigma: float
    dP: float = 0.0
    dM: float = 0.0

    def loads(self, t: Any) -> Any:
        """At t from -1/2 to 1/2."""
        Q = 2 * self.dQ * F * self.P * t
        return self.P * (1 + self.dP * t), self.M + self.dM * t, Q, self.dsigma * t

    def exact(self) -> Any:
        """The module's exact zone."""
        case = CASES[self.body]
        P, M, Q, sigma = self.loads(np.array([-0.5, 0.5]))
        given = {"E_star": 1.0, **case.own}
        first, second = (case.module.contact(p, m, **given) for p, m in zip(P, M, strict=True))
        dQ, dsigma = Q[1] - Q[0], sigma[1] - sigma[0]
        return case.module.stick_zone(first, second, dQ, dsigma, f=F, **given)


CLOSED = (
    Closed("hertz", np.pi / 4, 0.0, 0.3, 0.0),
    Closed("hertz", np.pi / 4, 0.02, 0.2, 0.6),
    Closed("hertz", np.pi / 4, 0.02, 0.3, 0.2, 0.1, 0.02),
    Closed("hertz", np.pi / 4, 0.0, 0.15, 0.8, 0.05),
    Closed("wedge", 1.0, 0.1, 0.3, 0.1),
    Closed("wedge", 1.0, 0.1, 0.15, 1.0, 0.1, 0.03),
    Closed("flat_rounded", 1.0, 0.05, 0.3, 0.1, 0.1, 0.02),
    Closed("rounded_wedge", 1.0, 0.02, 0.3, 0.1, 0.1),
    Closed("catenary", 1.0, 0.02, 0.25, 0.1, 0.1, 0.01),
)


def turning_points(one: Closed, tol: float) -> tuple[float, float]:
    """Of both ends of the second cycle: the worst error, and the least stated one over that."""
    t = np.array([-0.5, 0.5, -0.5, 0.5, -0.5])
    found, exact = on_elements(CASES[one.body], one.loads(t), tol), one.exact()
    assert exact.regime in (Regime.MODERATE, Regime.LARGE), one
    off = np.maximum(abs(found.m - exact.m), abs(found.n - exact.n))[3:] / (exact.m + exact.n)
    return float(off.max()), float(np.min(found.error[3:] / off))


def settled(one: Closed, tol: float) -> tuple[float, float]:
    """The same of the steady cycle."""
    t = np.array([-0.5, 0.5, -0.5])
    found, exact = on_elements(CASES[one.body], one.loads(t), tol, cycle=True), one.exact()
    assert found.rounds == 2, one  # in phase, the second round repeats the first
    off = max(abs(found.m - exact.m), abs(found.n - exact.n)) / (exact.m + exact.n)
    return float(off), float(found.error / off)


# ---------------------------------------------------------------- steady cycles


def in_phase(case: Case, rng: Any) -> Any:
    """A random cycle there and back: P varies by 0 to 40 %, M within +-0.03 P h."""
    t = np.array([-0.5, 0.5, -0.5])
    P = case.load * (1 + rng.uniform(0, 0.4) * rng.choice([-1, 1]) * t)
    M = case.load * case.width * (rng.uniform(-0.03, 0.03) + rng.uniform(-0.03, 0.03) * t)
    Q = F * case.load * 2 * rng.uniform(0.05, 0.35) * t
    return P, M, Q, F * case.load / case.width * rng.uniform(-3, 3) * t


def out_of_phase(case: Case, rng: Any) -> Any:
    """A random cycle in which every load has a phase of its own."""
    t, phases = np.linspace(0, 2 * np.pi, 13), rng.uniform(0, 2 * np.pi, 4)
    waves = [np.sin(t + phase) for phase in phases]
    P = case.load * (1 + rng.uniform(0, 0.3) * waves[0])
    M = case.load * case.width * (rng.uniform(-0.03, 0.03) + rng.uniform(-0.03, 0.03) * waves[1])
    Q = F * case.load * (rng.uniform(-0.1, 0.1) + rng.uniform(0.05, 0.4) * waves[2])
    return P, M, Q, F * case.load / case.width * rng.uniform(0, 1.5) * waves[3]


# ---------------------------------------------------------------- coverage


def covered(
    function: str, cases: int, tol: float = 1e-3, fine: float = 1e-4
) -> list[tuple[float, float]]:
    """Errors of zones and the stated ones, relative to the contact width; the truth is that of
    finer meshes."""
    rng, found = np.random.default_rng(7), list[tuple[float, float]]()
    for k in range(cases):
        case = list(CASES.values())[k % len(CASES)]
        if function == "history":
            loads = random_loads(case, rng, 7, varies=k // 5 % 2 == 0, smooth=k // 10 % 2 == 0)
        else:
            loads = (in_phase if k % 2 else out_of_phase)(case, rng)
        edges = case.module.contact(loads[0], loads[1], E_star=1.0, **case.own)
        a, c = np.max(edges.a), np.max(edges.c)
        rows = np.array(np.broadcast_arrays(*loads), dtype=float)
        solve = getattr(refine, function)
        body = case.module._BODY, case.own, F, rows, np.zeros(0)
        here, truth = (solve(*body, t) for t in (tol, fine))
        h = np.broadcast_to(edges.a + edges.c, rows.shape[1:]) if function == "history" else a + c
        off = np.atleast_1d(np.maximum(abs(here.m - truth.m), abs(here.n - truth.n)) / h)
        known = np.isfinite(off) & np.isfinite(here.error)
        found.extend(zip(off[known], np.atleast_1d(here.error)[known], strict=True))
    return found


# ---------------------------------------------------------------- energy


class Works(NamedTuple):
    """In the third round of a cycle: friction's work, and the work of Q and sigma."""

    friction: float
    by_shear: float


def _turned(load: float, dP: float, M: float, Q: float, sigma: float, instants: int = 65) -> Any:
    """A cycle, every load ahead of the one before."""
    t = np.linspace(0, 2 * np.pi, instants)
    P = load * (1 + dP * np.sin(t + 3))
    return P, M * np.cos(t + 2), Q * F * load * np.sin(t + 1), sigma * np.sin(t)


TURNED = {
    "hertz": _turned(np.pi / 4, 0.2, 0.0, 0.3, 0.0),
    "wedge": _turned(1.0, 0.0, 0.0, 0.4, 0.2),
    "flat_rounded": _turned(1.0, 0.1, 0.03, 0.3, 0.2),
    "rounded_wedge": _turned(1.0, 0.15, 0.03, 0.3, 0.2),
}
"""Cycles out of phase whose middle sticks."""


def works(case: Case, loads: Any, fine: int = 4) -> Works:
    """Friction's work beside that of Q and sigma, from shear at 600 places, in so many parts of the
    way between two instants.

    Where the surfaces stick at x0, Q moves with u, the displacement at x0 by q.  Tension strains
    the one body by sigma/E*, say, and works on its other ends' displacement, which reciprocity
    gives as X, the integral of q x: a cycle's work is, over E*,

        2 (int Q du + int (x0 Q - X) dsigma/4).
    """
    own, count = case.constants, fine * (len(loads[0]) - 1) + 1
    way, parts = np.linspace(0, 1, len(loads[0])), np.linspace(0, 1, count)
    finer = [np.interp(parts, way, v) for v in np.broadcast_arrays(*loads)]
    thrice = [np.concatenate([v, v[1:], v[1:]]) for v in finer]
    plain = case.module.history(*thrice, **own)
    a, c = plain.a.max(), plain.c.max()
    nodes = (c - a) / 2 - (a + c) / 2 * np.cos(np.linspace(0, np.pi, 601))
    x, w = (nodes[1:] + nodes[:-1]) / 2, np.diff(nodes)
    found = case.module.history(*thrice, x=x, **own)
    last = slice(-count, None)
    Q, sigma = (v[last] for v in thrice[2:])
    at = np.argmin(abs(x))
    x0 = float(x[at])
    assert np.ptp(found.slip[last, at]) == 0, "the middle slips"
    distance = abs(nodes - x0)
    potential = -np.diff(np.sign(nodes - x0) * distance * (np.log(distance) - 1)) / np.pi
    q = found.q[last]
    by_tension = np.trapezoid((x0 * Q - q @ (w * x)) / 4, sigma)
    by_shear = 2 * (np.trapezoid(Q, q @ potential) + by_tension)
    work = found.work[last]
    return Works(work[-1] - work[0], float(by_shear))


def table(quick: bool = False) -> Iterator[str]:
    """All lines."""
    for function in ("history", "steady_cycle"):
        off, stated = np.transpose(covered(function, 6 if quick else 50))
        share = np.mean(off <= stated + 1e-15)
        yield f"{function}  {share:.1%} of {off.size} covered, median error {np.median(off):.1e}"
    for name, loads in TURNED.items():
        found = works(CASES[name], loads)
        off = found.friction / found.by_shear - 1
        yield f"work, {name:13}  over that of Q and sigma, less 1: {off:.1e}"


if __name__ == "__main__":
    for line in table("--quick" in sys.argv[1:]):
        print(line, flush=True)
