"""The worst relative error of every generated function, region by region."""

import importlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf

from derive.codegen.contract import CONTRACT
from generated.runtime.types import Regime
from tests.derive.bodies import of_library as sheet_of
from tests.measure.accuracy import partial_slip
from tests.measure.accuracy.definitions import formula
from tests.measure.accuracy.partial_slip import digits_of
from tests.measure.accuracy.reference import Answer, Given, Problem, function_of
from tests.measure.accuracy.regions import BULK, Placed, Regions, Sample, contacts_of

BOUNDS = {True: 1e-13, False: 1e-12}
"""Of relative errors, in the bulk and elsewhere."""

EXACT = ("hertz", "wedge", "unequal_wedge", "quartic", "parabola_quartic")
EXPLICIT = 1e-14
"""The bound of explicit formulas of these bodies, in every region."""

ROUNDING = 1e-15
"""What rounding may do to a number whose condition is one: some units in the last place."""

Results = Callable[[Any, Regions, Sample], Sequence[Any]]
"""Numbers of a generated module at a sample."""

Scale = Callable[[str, list[mpf], Given], list[mpf]]
"""What the error of each number is relative to."""


@dataclass(frozen=True)
class Measured:
    """One function, or one regime of one.

    results  its numbers; scale: what their errors are relative to
    starts   the unknowns from which they are told, if they are not the unknowns themselves
    share    of the points asked for; integrated: the same where a pressure is an integral
    """

    name: str
    results: Results
    problem: Callable[[str], Problem]
    where: Callable[[Regions], Placed]
    scale: Scale
    starts: Results = lambda module, regions, sample: ()
    share: float = 1.0
    integrated: float = 0.05

    def points(self, body: str, count: int) -> int:
        """How many random points of a body are tried in a region; none where they are too dear."""
        known = sheet_of(body).geometry.slope.is_polynomial
        share = self.share if known else min(self.share, self.integrated)
        return max(2, round(share * count)) if share else 0


@dataclass(frozen=True)
class Worst:
    """The worst of one function in one region.

    error      relative; met: whether each is within its bound, or explained by rounded inputs
    condition  that of the problem where the error exceeds its bound
    lost       points at which the function gave no number, or none next to a solution
    """

    body: str
    function: str
    region: str
    points: int = 0
    lost: int = 0
    error: float = 0.0
    met: bool = True
    condition: float = 0.0
    point: dict[str, float] = field(default_factory=dict)


def bound(body: str, function: str, region: str) -> float:
    """The largest relative error that is allowed."""
    explicit = any(f.name == function and f.available(sheet_of(body)) for f in CONTRACT)
    return EXPLICIT if body in EXACT and explicit else BOUNDS[region == BULK]


# ------------------------------------------------------------------ what errors are relative to


def _itself(_: str, numbers: list[mpf], __: Given) -> list[mpf]:
    return [abs(v) for v in numbers]


def _larger(_: str, numbers: list[mpf], __: Given) -> list[mpf]:
    return [max(map(abs, numbers))] * len(numbers)


def _width(_: str, numbers: list[mpf], given: Given) -> list[mpf]:
    known = {"a": numbers[0], "c": numbers[1]} if "a" not in given else given
    return [known["a"] + known["c"]] * len(numbers)


def _contact(body: str, numbers: list[mpf], given: Given) -> list[mpf]:
    h = numbers[0] + numbers[1]
    return [h, h, given.get("P", mpf(0)) / (given["E_star"] * h)][: len(numbers)]


def _moments(body: str, _: list[mpf], given: Given) -> list[mpf]:
    return [formula(body, "load")(**given) * (given["a"] + given["c"])]


def _tilts(body: str, _: list[mpf], given: Given) -> list[mpf]:
    load = formula(body, "load")(**{**given, "E_star": mpf(1)})
    return [load / (given["a"] + given["c"])]


def _second(body: str, numbers: list[mpf], given: Given) -> list[mpf]:
    """L_N, or K_N over the width."""
    first = [formula(body, f"K_N_{side}")(**given) for side in ("left", "right")]
    width = given["a"] + given["c"]
    return [max(abs(v), K / width) for v, K in zip(numbers, first, strict=True)]


def _friction(body: str, _: list[mpf], given: Given) -> list[mpf]:
    return [2 * given["f"] * formula(body, "pressure")(**given)]


# ------------------------------------------------------------------ the catalogue


def _explicit(function: Any) -> Measured:
    def results(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
        names = map(str, (*function.arguments, *function.keywords(regions.sheet)))
        found = getattr(module, function.name)(**{n: sample[n] for n in names})
        return found if function.kind else (found,)

    def problem(body: str) -> Problem:
        polynomial = sheet_of(body).geometry.slope.is_polynomial

        def of(source: str) -> Callable[..., mpf]:
            if function.geometric:
                return formula(body, source)
            names, value = function_of(sheet_of(body).flat(source))
            return lambda **given: value(*(given[n] for n in names))

        sources = [of(source) for _, source in function.fields]
        told = lambda _, given: [source(**given) for source in sources]  # noqa: E731
        return Problem(told=told, digits=120 if polynomial or not function.geometric else 36)

    scales = {"tilt": _tilts, "moment": _moments, "L_N": _second}
    where = {"pressure": Regions.places}.get(function.name, Regions.contacts)
    scale = scales.get(function.name, _itself if function.geometric else _larger)
    where = where if function.geometric else Regions.sheared
    return Measured(function.name, results, problem, where, scale)


def _from_loads(name: str, *given: str) -> Measured:
    fields = {"P": "load", "M": "moment", "alpha": "tilt"}

    def results(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
        law = regions.law_of(sample, friction=False)
        found = getattr(module, name)(*(sample[n] for n in given), **law)
        return found if name == "contact" else found[:2]

    def problem(body: str) -> Problem:
        laws = {n: formula(body, fields[n]) for n in given}
        tilt = formula(body, "tilt")

        def at(edges: Sequence[mpf], known: Given) -> dict[str, mpf]:
            return {**known, "a": edges[0], "c": edges[1]}

        def told(edges: Sequence[mpf], known: Given) -> Sequence[mpf]:
            return [*edges, tilt(**at(edges, known))] if name == "contact" else edges

        polynomial = sheet_of(body).geometry.slope.is_polynomial
        return Problem(
            lambda edges, known: [law(**at(edges, known)) - known[n] for n, law in laws.items()],
            told,
            80 if polynomial else 36,
        )

    where = lambda regions: regions.loaded(*given)  # noqa: E731
    first = lambda *of: results(*of)[:2]  # noqa: E731
    return Measured(name, results, problem, where, _contact, first, 0.2)


def _zone(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    return regions.zone_of(sample)[:2]


def _cycle(name: str, module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    """A function of a half-cycle; at x, where there is one."""
    loads = [sample["dQ"], *([sample["dsigma"]] if "x" in sample else [])]
    places = [sample["x"]] if "x" in sample else []
    found = getattr(module, name)(*places, *contacts_of(sample), *loads, **regions.law_of(sample))
    return (found,) if places else found


def _shear(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    fall = {"dQ": sample["dQ"], "dsigma": sample["dsigma"]}
    here = contacts_of(sample)[0]
    rise = sample["Q"], sample["sigma"]
    return (module.shear(sample["x"], here, *rise, **regions.law_of(sample), **fall),)


def _shear_zones(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    risen = {**sample, "dQ": 2 * sample["Q"], "dsigma": 2 * sample["sigma"]}
    return [*regions.zone_of(risen)[:2], *regions.zone_of(sample)[:2]]


def _series(order: int, module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    given = [sample[n] for n in ("a", "c", "dQ", "dsigma")]
    return module.slip_zones(*given, order=order, **regions.law_of(sample))


WAY = np.array([0.0, 0.25, 0.75, 1.0, 0.75, 0.5])
"""How far the loads of a march have come, instant by instant; the last is judged, half a fall."""


def _march(module: Any, regions: Regions, sample: Sample) -> Sequence[Any]:
    law = {n: v[:, None] for n, v in regions.law_of(sample).items()}
    edges = sample["a"][:, None], sample["c"][:, None]
    normal = {n: v for n, v in law.items() if n != "f"}
    loads = [of(*edges, **normal) for of in (module.load, module.moment)]
    found = module.march(*loads, *(sample[n][:, None] * WAY for n in ("dQ", "dsigma")), **law)
    return [v[:, -1] for v in (found.m, found.n)]


def _half_fallen(body: str) -> Problem:
    """The stick zone half of the half-cycle's change after the loads have turned."""
    zone = partial_slip.patch(body)

    def off(edges: Sequence[mpf], given: Given) -> Sequence[mpf]:
        return zone(edges, {**given, **{n: given[n] / 2 for n in ("dQ", "dsigma")}})

    return Problem(off)


_MODERATE, _LARGE = Regime.MODERATE, Regime.LARGE

CATALOGUE = (
    *(_explicit(f) for f in CONTRACT if f.name not in ("contact", "contact_at_tilt")),
    _from_loads("contact", "P", "M"),
    _from_loads("contact_at_tilt", "P", "alpha"),
    *(
        Measured(
            f"stick_zone, moderate{words}",
            _zone,
            lambda body: Problem(partial_slip.patch(body)),
            partial(Regions.cycles, regime=_MODERATE, varied=bool(words)),
            _width,
            _zone,
            0.2,
        )
        for words in ("", ", varying")
    ),
    *(
        Measured(
            f"stick_zone, large{words}",
            _zone,
            lambda body: Problem(partial_slip.between(body), digits=digits_of(body)),
            partial(Regions.cycles, regime=_LARGE, varied=bool(words)),
            _width,
            _zone,
            *shares,
        )
        for words, shares in (("", (0.04, 0.01)), (", varying", (0.02, 0.0)))
    ),
    Measured(
        "tension_threshold",
        partial(_cycle, "tension_threshold"),
        lambda body: Problem(told=lambda _, given: partial_slip.threshold(given)),
        lambda regions: regions.cycles(_MODERATE),
        _itself,
        share=0.2,
    ),
    *(
        Measured(
            f"slip_zones, order {order}",
            partial(_series, order),
            lambda body, order=order: Problem(partial_slip.series(body, order)),  # type: ignore[misc]
            lambda regions: regions.cycles(_MODERATE),
            _width,
            partial(_series, order),
            0.1,
        )
        for order in (1, 2)
    ),
    Measured(
        "shear",
        _shear,
        partial_slip.shear,
        Regions.risen_and_fallen,
        _friction,
        _shear_zones,
        0.1,
    ),
    *(
        Measured(
            f"{name}, {regime.name.lower()}",
            partial(_cycle, name),
            partial(problem, large=regime == _LARGE),
            partial(Regions.placed, regime=regime, slips=name == "slip_range"),
            scale,
            _zone,
            *shares,
        )
        for name, problem, scale, regime, shares in (
            ("shear_change", partial_slip.change, _friction, _MODERATE, (0.1,)),
            ("shear_change", partial_slip.change, _friction, _LARGE, (0.03, 0.0)),
            ("slip_range", partial_slip.slip, _itself, _MODERATE, (0.03, 0.0)),
            ("slip_range", partial_slip.slip, _itself, _LARGE, (0.02, 0.0)),
        )
    ),
    Measured(
        "march",
        _march,
        _half_fallen,
        lambda regions: regions.cycles(_MODERATE),
        _width,
        _march,
        0.1,
    ),
)


# ------------------------------------------------------------------ the worst of many


def worst_of(body: str, name: str, count: int) -> Iterator[Worst]:
    """One function of one body in every region."""
    of = next(entry for entry in CATALOGUE if entry.name == name)
    module = importlib.import_module(f"generated.{body}")
    found: dict[str, list[Worst]] = {}
    if points := of.points(body, count):
        regions = Regions(sheet_of(body), module, points)
        for region, sample in of.where(regions):
            if sample["E_star"].size:
                found.setdefault(region, []).append(_worst(body, of, region, regions, sample))
    for rows in found.values():
        worst = max(rows, key=lambda row: (not row.met, row.error))
        total = {n: sum(getattr(row, n) for row in rows) for n in ("points", "lost")}
        yield Worst(**{**worst.__dict__, **total})


def _worst(body: str, of: Measured, region: str, regions: Regions, sample: Sample) -> Worst:
    module, problem = regions.module, of.problem(body)
    results = np.array(np.broadcast_arrays(*of.results(module, regions, sample)), dtype=float)
    begun = of.starts(module, regions, sample)
    starts = [*zip(*begun, strict=True)] if len(begun) else [()] * results.shape[1]
    limit = bound(body, of.name, region)
    lost, worst = 0, Worst(body, of.name, region)
    for k in range(results.shape[1]):
        point = {n: float(v[k]) for n, v in sample.items()}
        answer = _answer(problem, starts[k], point)
        if answer is None or not np.all(np.isfinite(results[:, k])):
            lost += 1
            continue
        with mpmath.workdps(problem.digits):
            try:
                scales = of.scale(body, answer.numbers, answer.given)
            except ArithmeticError:  # the sheet has too few digits here
                lost += 1
                continue
            for i, (value, number) in enumerate(zip(results[:, k], answer.numbers, strict=True)):
                scale = scales[i] or mpf(1)
                error = float(abs(mpf(value) - number) / scale)
                condition = answer.moved[i] / float(scale) if error > limit else 0.0
                met = error <= max(limit, ROUNDING * condition)
                if (not met, error) > (not worst.met, worst.error):
                    worst = Worst(body, of.name, region, 0, 0, error, met, condition, point)
    return Worst(**{**worst.__dict__, "points": results.shape[1], "lost": lost})


def _answer(problem: Problem, start: Sequence[Any], point: dict[str, float]) -> Answer | None:
    """The solution next to what a function gave; None where there is none."""
    if not np.all(np.isfinite(np.array(start, dtype=float))):
        return None
    try:
        return problem.answer([float(v) for v in start], point)
    except (ArithmeticError, ValueError):
        return None
