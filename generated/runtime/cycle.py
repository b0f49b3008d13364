"""What the functions of a body call that are solved numerically, from contacts to slip.

Each takes the body, its parameters by name, and then the arguments of the public function, whose
docstring in the generated module says what it returns.
"""

from typing import Any, NamedTuple

import numpy as np

from .arrays import demand_order, numbers_of, shape_of, solved
from .body import Body
from .chunks import any_lazy
from .forward import each_contact, each_contact_at_tilt, each_pressure, each_series, each_state
from .reasons import reason
from .slip.mixed import each_mixed_zone
from .slip.series import each_slip_zones
from .slip.shear import each_shear_change, each_slip_range, rises_and_falls
from .slip.zone import each_constant_zone, each_zone
from .types import Array, Contact, Edges, Regime, StickZone, Threshold, Values

Own = dict[str, Any]
"""The parameters of a body, by name."""

HalfCycle = tuple[Contact, Contact, Values, Values, Values, Values]
"""first, second, dQ, dsigma, f and E_star."""


def edges_of(contact: Any, label: str) -> dict[str, Any]:
    """The edges of a Contact, by their names in messages.

    Raises TypeError for anything that is not a Contact.
    """
    try:
        return {f"{label}.a": contact.a, f"{label}.c": contact.c}
    except AttributeError:
        raise TypeError(
            f"{label} must be a Contact, as returned by contact(...); got {contact!r:.60}"
        ) from None


def _named(half_cycle: HalfCycle) -> tuple[Own, Own]:
    """The edges and the loads of a half-cycle by their names, and f and E*."""
    first, second, dQ, dsigma, f, E_star = half_cycle
    edges = edges_of(first, "first") | edges_of(second, "second")
    return edges | {"dQ": dQ, "dsigma": dsigma}, {"f": f, "E_star": E_star}


# ---------------------------------------------------------------- a contact


class _State(NamedTuple):
    """Load, moment, tilt and edge coefficients of a contact."""

    load: Array
    moment: Array
    tilt: Array
    left: Array
    right: Array


class _Series(NamedTuple):
    """Slip zones to the first and to the second order."""

    left: Array
    right: Array
    left_2: Array
    right_2: Array


def _state(body: Body, own: Own, a: Values, c: Values, E_star: Values = 1.0) -> Any:
    return solved(each_state, body, {"a": a, "c": c}, {"E_star": E_star}, own, _State)


def load(body: Body, own: Own, a: Values, c: Values, E_star: Values) -> Array:
    """The load of a body without a formula for it."""
    return _state(body, own, a, c, E_star).load


def moment(body: Body, own: Own, a: Values, c: Values, E_star: Values) -> Array:
    """The moment of a body without a formula for it."""
    return _state(body, own, a, c, E_star).moment


def tilt(body: Body, own: Own, a: Values, c: Values) -> Array:
    """The tilt of a body without a formula for it."""
    return _state(body, own, a, c).tilt


def K_N(body: Body, own: Own, a: Values, c: Values, E_star: Values) -> Edges:
    """K_N of a body without a formula for it."""
    state = _state(body, own, a, c, E_star)
    return Edges(state.left, state.right)


def L_N(body: Body, own: Own, a: Values, c: Values, E_star: Values) -> Edges:
    """L_N of a body without a formula for it."""
    found: Edges = solved(each_series, body, {"a": a, "c": c}, {"E_star": E_star}, own, Edges)
    return found


def pressure(body: Body, own: Own, x: Values, a: Values, c: Values, E_star: Values) -> Array:
    """The pressure of a body without a formula for it."""
    return solved(each_pressure, body, {"x": x, "a": a, "c": c}, {"E_star": E_star}, own)


def contact(body: Body, own: Own, P: Values, M: Values, E_star: Values) -> Contact:
    """The contact under a load and a moment."""
    found: Contact = solved(each_contact, body, {"P": P, "M": M}, {"E_star": E_star}, own, Contact)
    return found


def contact_at_tilt(body: Body, own: Own, P: Values, alpha: Values, E_star: Values) -> Contact:
    """The contact under a load at a given tilt."""
    found: Contact = solved(
        each_contact_at_tilt, body, {"P": P, "alpha": alpha}, {"E_star": E_star}, own, Contact
    )
    return found


# ---------------------------------------------------------------- the stick zone


def stick_zone(body: Body, own: Own, half_cycle: HalfCycle, mixed: bool = False) -> StickZone:
    """The zone that sticks throughout a steady cycle, and how the cycle slips.

    Raises TypeError if `mixed` is not True or False.
    """
    if not isinstance(mixed, bool | np.bool_):
        raise TypeError(f"mixed must be True or False, one value for all; got {mixed!r:.60}")
    return stick_zones(body, *_named(half_cycle), own, bool(mixed))


def stick_zones(body: Body, given: Own, constants: Own, own: Own, mixed: bool) -> StickZone:
    """Stick zones; `given` are the edges of both contacts, then dQ and dsigma, in this order."""
    each = each_zone if _varies(given) else each_constant_zone
    if mixed:
        each = each_mixed_zone
    zone: StickZone = solved(each, body, given, constants, own, StickZone, ("regime",))
    return zone


def _varies(given: Own) -> bool:
    """Whether any contact may change; Dask arrays are not compared."""
    edges = {name: given[name] for name in list(given)[:4]}
    a, c, a_2, c_2 = edges.values()
    if a is a_2 and c is c_2:
        return False
    a, c, a_2, c_2 = numbers_of(edges, {}).values()
    is_lazy = any_lazy([a, c, a_2, c_2])
    return is_lazy or not (np.array_equal(a, a_2) and np.array_equal(c, c_2))


def why(body: Body, own: Own, half_cycle: HalfCycle, demands: str) -> str:
    """Why a cycle has no stick zone, or what its regime means, in words.

    Raises ValueError if an argument is an array.
    """
    zone = stick_zone(body, own, half_cycle)
    if np.ndim(zone.regime):
        raise ValueError(
            "`why` takes one cycle, with numbers as arguments; got arrays of shape "
            f"{np.shape(zone.regime)}"
        )
    first, second, dQ, dsigma, f, E_star = half_cycle
    return reason(
        Regime(int(zone.regime)),
        numbers_of({"f": f, "E_star": E_star, **own}, {}),
        numbers_of({"dQ": dQ, "dsigma": dsigma}, {}),
        {"first": (first.a, first.c), "second": (second.a, second.c)},
        demands,
    )


def tension_threshold(body: Body, own: Own, half_cycle: HalfCycle) -> Threshold:
    """The changes in tension between which tension is moderate, under constant normal loads.

    half_cycle: without a change in tension.
    """
    zone = stick_zone(body, own, half_cycle)
    a, c, a_2, c_2, dQ, _ = numbers_of(_named(half_cycle)[0], {}).values()
    known = (a == a_2) & (c == c_2) & np.isfinite(zone.m)
    limit = np.where(known, 8 * dQ / (np.pi * (a + c)), np.nan)[()]
    return Threshold(-limit, limit)


# ---------------------------------------------------------------- slip zones by series


def _series(body: Body, own: Own, arguments: tuple[Values, ...], order: int) -> _Series:
    demand_order(order)
    a, c, dQ, dsigma, f, E_star, da, dc = arguments
    given = {"a": a, "c": c, "dQ": dQ, "dsigma": dsigma, "da": da, "dc": dc}
    found: _Series = solved(each_slip_zones, body, given, {"f": f, "E_star": E_star}, own, _Series)
    return found


def slip_zones(body: Body, own: Own, *arguments: Values, order: int) -> Edges:
    """Slip zones by their series."""
    found = _series(body, own, arguments, order)
    return Edges(*(found[:2] if order == 1 else found[2:]))


def slip_error(body: Body, own: Own, *arguments: Values, order: int) -> Edges:
    """The estimated error of the slip zones: the second term, or its square over the zone."""
    first, second = (found := _series(body, own, arguments, order))[:2], found[2:]
    with np.errstate(all="ignore"):
        errors = [abs(two - one) for one, two in zip(first, second, strict=True)]
        if order == 2:
            longer = map(np.fmax, first, second)  # the first order vanishes with K_T
            errors = [error * error / d for error, d in zip(errors, longer, strict=True)]
    return Edges(*errors)


# ---------------------------------------------------------------- shear and slip


def shear_change(body: Body, own: Own, x: Values, half_cycle: HalfCycle) -> Array:
    """The change in the shear traction over a half-cycle."""
    return _at_places(each_shear_change, body, own, x, half_cycle)[1]


def slip_range(body: Body, own: Own, x: Values, half_cycle: HalfCycle) -> Array:
    """The slip range over a half-cycle."""
    return _at_places(each_slip_range, body, own, x, half_cycle)[1]


def _at_places(
    loop: Any, body: Body, own: Own, x: Values, half_cycle: HalfCycle
) -> tuple[StickZone, Array]:
    """The stick zone, solved once per cycle, and what a loop finds at places x."""
    zone = stick_zone(body, own, half_cycle)
    given, constants = _named(half_cycle)
    return zone, solved(loop, body, {**given, **zone._asdict(), "x": x}, constants, own)


def shear(
    body: Body, own: Own, x: Values, contact: Contact, loads: Any, f: Values, E_star: Values
) -> Array:
    """The shear traction after a rise of the loads from zero and a fall.

    loads: Q, sigma, dQ and dsigma.
    """
    named = dict(zip(("Q", "sigma", "dQ", "dsigma"), loads, strict=True))
    numbers = numbers_of(edges_of(contact, "contact") | named, {})
    shape_of(numbers | numbers_of({"x": x}, {"f": f, "E_star": E_star, **own}))
    a, c, Q, sigma, *fall = numbers.values()
    rise = [2 * Q, 2 * sigma]
    (risen, up), (fallen, down) = (
        _at_places(each_shear_change, body, own, x, (contact, contact, *changes, f, E_star))
        for changes in (rise, fall)
    )
    with np.errstate(all="ignore"):
        known = rises_and_falls((a, c), rise, risen, fall, fallen)
        return np.where(known, up / 2 - down, np.nan)[()]
