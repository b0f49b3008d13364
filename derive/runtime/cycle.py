"""Functions of a body that are solved numerically: contacts, stick zones, slip, shear, a march.

The first argument of each function here is an `Asked`, which knows the body; `Body.bound` turns the
function into the public one and completes its docstring.  The kernels are loaded on first use.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from .arrays import shape_of
from .body import Asked, kernel_of, numbers_of, with_options
from .chunks import any_lazy, over_chunks
from .reasons import reason
from .types import Array, Contact, Edges, March, Regime, StickZone, Threshold

_BOTH = ("first.a", "first.c", "second.a", "second.c")
_LOADS = ("dQ", "dsigma")


def _edges_of(contact: Any, label: str) -> dict[str, Any]:
    """The edges of a Contact, by their names in messages.

    Raises TypeError for anything that is not a Contact.
    """
    try:
        return {f"{label}.a": contact.a, f"{label}.c": contact.c}
    except AttributeError:
        raise TypeError(
            f"{label} must be a Contact, as returned by contact(...); got {contact!r:.60}"
        ) from None


def _between(first: Any, second: Any, **others: Any) -> dict[str, Any]:
    return _edges_of(first, "first") | _edges_of(second, "second") | others


def _demand_order(order: Any, least: int, most: int) -> None:
    """Raise TypeError unless the order is a whole number, ValueError unless it is in the range."""
    if isinstance(order, bool) or not isinstance(order, int | np.integer):
        raise TypeError(f"order must be a whole number; got {order!r:.60}")
    if not least <= order <= most:
        raise ValueError(f"order must be from {least} to {most}; got {order}")


# ---------------------------------------------------------------- state of a contact


class _State(NamedTuple):
    """Load, moment, tilt and edge coefficients of a contact."""

    load: Array
    moment: Array
    tilt: Array
    left: Array
    right: Array


class _Series(NamedTuple):
    """Slip zones and their estimated errors."""

    left: Array
    right: Array
    error_left: Array
    error_right: Array


def integrated(asked: Asked, a: Array, c: Array, *, E_star: Array = 1.0, x: Array = None) -> Any:
    """A quantity of a contact by quadrature; the name of the called function tells which one.

    The generated module shows the integral in its docstring.
    """
    name = asked.call.__name__
    place = {"x": x} if name == "pressure" else {}
    given = {**place, "a": a, "c": c}
    constants = {} if name == "tilt" else {"E_star": E_star}
    loop, kind = {"pressure": ("pressure", None), "L_N": ("series", _Series)}.get(
        name, ("state", _State)
    )
    result = asked.solved(
        f"forward.each_{loop}", given, constants, tuple(given), kind, by_modulus=name != "tilt"
    )
    if name in ("K_N", "L_N"):
        return result if isinstance(result, Edges) else Edges(result.left, result.right)
    return getattr(result, name, result)


# ---------------------------------------------------------------- contacts from loads


def contact(asked: Asked, P: Array, M: Array = 0.0, *, E_star: Array) -> Contact:
    """Contact and tilt under the load P and the moment M.

        P = load(a, c), M = moment(a, c), alpha = tilt(a, c)

    The first two equations are solved for a and c by Newton's method.

    Returns
    -------
    Contact
        a [m], c [m], alpha [rad].  NaN unless P > 0, E_star > 0, the body's own parameters
        are positive and a contact exists.  Derivatives follow from K_N: when an edge moves, the
        pressure changes by that of a flat punch.
    """
    given, loads = {"P": P, "M": M}, ("P", "M")
    return asked.solved(
        "forward.each_contact", given, {"E_star": E_star}, loads, Contact, over_modulus=loads
    )


def contact_at_tilt(asked: Asked, P: Array, alpha: Array = 0.0, *, E_star: Array) -> Contact:
    """Contact under the load P at the tilt alpha.

        P = load(a, c), alpha = tilt(a, c)

    The equations are solved for a and c by Newton's method.

    Returns
    -------
    Contact
        a [m], c [m], alpha as given.  NaN unless P > 0, E_star > 0, the body's own
        parameters are positive and a contact exists.  Derivatives follow from K_N: when an edge
        moves, the pressure changes by that of a flat punch.
    """
    return asked.solved(
        "forward.each_contact_at_tilt",
        {"P": P, "alpha": alpha},
        {"E_star": E_star},
        ("P", "alpha"),
        Contact,
        over_modulus=("P",),
    )


# ---------------------------------------------------------------- the stick zone


def stick_zone(
    asked: Asked,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
    mixed: bool = False,
) -> StickZone:
    """The zone [-m, n] that sticks throughout a steady cycle, and how the cycle slips.

        moderate tension: load(m, n) = (P_1 + P_2)/2 - dQ/(2 f),
            tilt(m, n) = (alpha_1 + alpha_2)/2 - dsigma/(4 f E*)
        large tension: int r sqrt((xi + m)/(xi - n)) dxi = dQ - pi dsigma (m + n)/8,
            int r sqrt((xi - n)/(xi + m)) dxi = dQ + pi dsigma (m + n)/8 over the slip zones,
            r = +/- f (p_1 + p_2), the upper sign on the left if dsigma > 0

    Returns
    -------
    StickZone
        m [m], n [m], and regime, a code of Regime.  m and n are NaN unless the regime is
        MODERATE, LARGE or FULL_STICK.  They are also NaN if dQ < 0, or if dQ >= f (P_1 + P_2),
        because the contact then slides.  If slip reverses within a half-cycle (MIXED), they are
        given only under constant normal loads, and only if forward slip eventually covers the
        zone of reversed slip or if `mixed` is True.  This function knows only the changes in the
        loads.  Under large tension, if slip reverses, or if a moment rocks the contact, no zone
        sticks if the mean shear load is too high; steady_cycle checks this, and march does unless
        slip reverses.  steady_cycle solves every cycle and estimates the error of computed results.

    Raises
    ------
    TypeError
        If a contact is not a Contact, or another argument is not a real number or an array of them,
        or `mixed` is not True or False.
    ValueError
        If the shapes of the arguments do not broadcast.
    """
    if not isinstance(mixed, bool | np.bool_):
        raise TypeError(f"mixed must be True or False, one value for all; got {mixed!r:.60}")
    zone: StickZone = asked.solved(
        f"slip.{'mixed' if mixed else 'zone'}.each_stick_zone",
        _between(first, second, dQ=dQ, dsigma=dsigma),
        {"f": f, "E_star": E_star},
        (*_BOTH, "dQ", "dsigma", "f"),
        StickZone,
        over_modulus=_LOADS,
        options={"mixed": bool(mixed)},
    )
    return zone._replace(regime=zone.regime.astype(np.int64))


def why(
    asked: Asked,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
) -> str:
    """Why a cycle has no stick zone, or what its regime means, in words.

    Returns
    -------
    str
        The meaning of the regime; where it is NONE, everything that is wrong with the numbers.

    Raises
    ------
    TypeError
        If `first` or `second` is not a Contact, or another argument is not a real number.
    ValueError
        If an argument is an array.

    Notes
    -----
    One cycle at a time: every argument is a number.  The docstring of Regime explains the codes of
    march, history and steady_cycle.
    """
    zone = stick_zone(asked, first, second, dQ, dsigma, f=f, E_star=E_star)
    if np.ndim(zone.regime):
        raise ValueError(
            "`why` takes one cycle, with numbers as arguments; got arrays of shape "
            f"{np.shape(zone.regime)}"
        )
    return reason(
        Regime(int(zone.regime)),
        {"f": f, "E_star": E_star, **asked.own},
        {"dQ": dQ, "dsigma": dsigma},
        {"first": (first.a, first.c), "second": (second.a, second.c)},
        asked.body.demands,
    )


def tension_threshold(
    asked: Asked, first: Contact, second: Contact, dQ: Array, *, f: Array, E_star: Array
) -> Threshold:
    """The two changes in bulk tension between which tension is moderate and the solution is exact.

        constant loads: dsigma = -/+ 8 dQ/(pi (a + c))

    Returns
    -------
    Threshold
        lower [Pa], upper [Pa].  NaN unless such a range exists.  Also NaN where dQ < 0, and where
        dQ >= f (P_1 + P_2), which means sliding.
    """
    return _tensions(asked, "tension_threshold", first, second, dQ, f, E_star)


def closing_tension(
    asked: Asked, first: Contact, second: Contact, dQ: Array, *, f: Array, E_star: Array
) -> Threshold:
    """Changes in bulk tension at which the moderate solution closes one slip zone.

        upper: load(m, c) = (P_1 + P_2)/2 - dQ/(2 f),
            dsigma = 4 f E* ((alpha_1 + alpha_2)/2 - tilt(m, c)),
            where c is the right edge of the smaller contact
        lower: the same with load(a, n) and tilt(a, n),
            where a is the left edge of the smaller contact

    Returns
    -------
    Threshold
        lower [Pa], upper [Pa].  Slip reverses before the zone closes; see tension_threshold.
        NaN unless the reduced load is positive and the stick zone fits into the smaller contact.
        Also NaN where dQ < 0, and where dQ >= f (P_1 + P_2), which means sliding.
    """
    return _tensions(asked, "closing_tension", first, second, dQ, f, E_star)


def _tensions(
    asked: Asked, name: str, first: Any, second: Any, dQ: Array, f: Array, E_star: Array
) -> Threshold:
    result: Threshold = asked.solved(
        f"slip.threshold.each_{name}",
        _between(first, second, dQ=dQ),
        {"f": f, "E_star": E_star},
        (*_BOTH, "dQ", "f"),
        Threshold,
        over_modulus=("dQ",),
        by_modulus=True,
    )
    return result


# ---------------------------------------------------------------- slip zones by series


def slip_zones(
    asked: Asked,
    a: Array,
    c: Array,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
    da: Array = 0.0,
    dc: Array = 0.0,
    order: int = 1,
) -> Edges:
    """Lengths of the slip zones, by series in these lengths.

        order 1: d = |K_T|/(f K_N) + da/2, and dc/2 at the right edge

    Orders 2 and 3 use the conditions of stick_zone with the first two or three terms of the
    pressure at each edge of both contacts, truncated after that power of d and then solved without
    further approximation, provided that part of the contact sticks to the first order.

    Returns
    -------
    Edges
        left [m], right [m].  NaN unless both edges slip and part of the contact sticks.  Also NaN
        where dQ < 0, and where dQ >= f (P_1 + P_2), which means sliding.
    """
    given = {"a": a, "c": c, "dQ": dQ, "dsigma": dsigma, "da": da, "dc": dc}
    _demand_order(order, 1, 3)
    return _series(asked, given, f, E_star, order, 0)


def slip_error(
    asked: Asked,
    a: Array,
    c: Array,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
    da: Array = 0.0,
    dc: Array = 0.0,
    order: int = 1,
) -> Edges:
    """Estimated error of the series for the slip zones: their change with one more term.

        |d(order + 1) - d(order)|

    Returns
    -------
    Edges
        left [m], right [m].  NaN unless both orders give slip zones.  Also NaN where dQ < 0, and
        where dQ >= f (P_1 + P_2), which means sliding.
    """
    given = {"a": a, "c": c, "dQ": dQ, "dsigma": dsigma, "da": da, "dc": dc}
    _demand_order(order, 1, 2)
    return _series(asked, given, f, E_star, order, 2)


def _series(
    asked: Asked, given: dict[str, Any], f: Array, E_star: Array, order: int, first: int
) -> Edges:
    """Slip zones (first = 0) or their errors (first = 2)."""
    result = asked.solved(
        "slip.series.each_slip_zones",
        given,
        {"f": f, "E_star": E_star},
        ("a", "c", "dQ", "dsigma", "f", "da", "dc"),
        _Series,
        over_modulus=_LOADS,
        options={"order": order},
    )
    return result if isinstance(result, Edges) else Edges(*result[first : first + 2])


# ---------------------------------------------------------------- shear and slip


def shear_change(
    asked: Asked,
    x: Array,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
) -> Array:
    """Change in the shear traction at x over the half-cycle; zero outside the contacts.

        dq = kappa f (p_1 + p_2) in the slip zones
        moderate tension: dq = f (p_1 + p_2) - 2 f p(x; m, n)
        large tension: dq = sqrt((x + m)(n - x))/pi int r/(w (xi - x)) dxi in the stick zone,
            w = sqrt((xi + m)(xi - n)), negative on the left

    Returns
    -------
    dq : ndarray
        [Pa].  If `second`, dQ and dsigma describe a part of a half-cycle, dq is the change up
        to that point, provided that the regime of the whole half-cycle is MODERATE or LARGE.
        NaN unless the stick zone is known without `mixed`.  Also NaN in full stick between two
        different contacts, where dQ < 0, and where dQ >= f (P_1 + P_2), which means sliding.
    """
    return _at_places(asked, "shear_change", x, first, second, dQ, dsigma, f, E_star)


def slip_range(
    asked: Asked,
    x: Array,
    first: Contact,
    second: Contact,
    dQ: Array,
    dsigma: Array,
    *,
    f: Array,
    E_star: Array,
) -> Array:
    """Slip range of the surfaces at x over the half-cycle; zero where they stick.

        (E*/2) d slip/dx = (1/pi) PV int dq/(x - xi) dxi - dsigma/4
        moderate tension and constant loads: 2 f times the gap outside the contact [-m, n]

    Returns
    -------
    slip : ndarray
        [m], positive.  NaN unless x lies in both contacts and the regime is MODERATE, LARGE
        or FULL_STICK.  Also NaN where dQ < 0, and where dQ >= f (P_1 + P_2), which means sliding.
    """
    return _at_places(asked, "slip_range", x, first, second, dQ, dsigma, f, E_star)


def _at_places(
    asked: Asked,
    name: str,
    x: Array,
    first: Any,
    second: Any,
    dQ: Array,
    dsigma: Array,
    f: Array,
    E_star: Array,
) -> Array:
    """Shear change or slip range; the stick zone is solved once per cycle for all positions x."""
    given = _between(first, second, dQ=dQ, dsigma=dsigma)
    constants = {"f": f, "E_star": E_star}
    lazy = any_lazy([x, *given.values(), *constants.values(), *asked.own.values()])
    zone = {} if lazy else _zone(asked, "", first, second, dQ, dsigma, f, E_star)
    return asked.solved(
        f"slip.shear.each_{name}",
        {"x": x, **given, **zone},
        constants,
        ("x", *_BOTH, "dQ", "dsigma", "f", "m", "n", "regime"),
        over_modulus=_LOADS,
        by_modulus=name == "shear_change",
    )


def _zone(asked: Asked, label: str, *cycle: Any) -> dict[str, Any]:
    """The stick zone of a cycle, by the names of its fields with a label appended to each."""
    *loads, f, E_star = cycle
    zone = stick_zone(asked, *loads, f=f, E_star=E_star)
    return {f"{field}{label}": value for field, value in zone._asdict().items()}


def shear(
    asked: Asked,
    x: Array,
    contact: Contact,
    Q: Array,
    sigma: Array,
    *,
    f: Array,
    E_star: Array,
    dQ: Array = 0.0,
    dsigma: Array = 0.0,
) -> Array:
    """Shear traction at x in a cycle at constant normal loads; zero outside the contact.

        q = dq(2 Q, 2 sigma)/2 - dq(dQ, dsigma), dq from shear_change

    First the shear load rises from zero to Q and the tension to sigma, in proportion; then they
    fall by dQ and dsigma, again in proportion.  A fall of zero gives q at the upper end of a cycle.
    The fall of a whole half-cycle gives q at the lower end, from which it rises again by
    shear_change.

    Returns
    -------
    q : ndarray
        [Pa]; in the stick zone, the mean of q at both ends of the cycle is the traction that
        the first rise locked in.  NaN unless the regimes of (2 Q, 2 sigma) and of (dQ, dsigma)
        are both MODERATE or both LARGE, or the latter is FULL_STICK.  Also NaN unless reverse
        slip is confined to points that slipped during the rise and drives none of them further
        in the same direction, and dQ <= 2 Q.  If the shear load is larger in magnitude at the lower
        end, reverse all signs, including that of q.  Also NaN where Q < 0 or dQ < 0, and where
        Q >= f P, which means sliding.
    """
    given = {"x": x, **_edges_of(contact, "contact"), "Q": Q, "sigma": sigma}
    given |= {"dQ": dQ, "dsigma": dsigma}
    constants = {"f": f, "E_star": E_star}
    numbers = numbers_of(given, constants)
    if not any_lazy([*numbers.values(), *asked.own.values()]):
        twice = 2 * numbers["Q"], 2 * numbers["sigma"]
        given |= _zone(asked, "_rise", contact, contact, *twice, f, E_star)
        given |= _zone(asked, "_fall", contact, contact, dQ, dsigma, f, E_star)
    zones = [f"{field}{label}" for label in ("_rise", "_fall") for field in StickZone._fields]
    return asked.solved(
        "slip.shear.each_shear",
        given,
        constants,
        ("x", "contact.a", "contact.c", "Q", "sigma", "dQ", "dsigma", "f", *zones),
        over_modulus=("Q", "sigma", "dQ", "dsigma"),
        by_modulus=True,
    )


# ---------------------------------------------------------------- a cycle through time


def march(
    asked: Asked,
    P: Array,
    M: Array,
    Q: Array,
    sigma: Array,
    *,
    f: Array,
    E_star: Array,
    order: int = 0,
) -> March:
    """A steady cycle instant by instant: contact, stick zone, direction of slip at the edges.

    Since the last reversal of the loads, at the least or the greatest Q, slip has grown as in a
    half-cycle that ends now: by stick_zone, or by slip_zones if an order is given.  This does not
    hold if the whole half-cycle is MIXED; then at most the state at its end is known.

    Returns
    -------
    March
        a, c, m, n [m]; left, right: +1 forward slip, -1 reverse slip, 0 none; regime.  All
        instants of a cycle are NaN, and the regime gives the reason, if it is OUT_OF_PHASE (the
        loads are not in proportion at every instant, to 1e-6 of their change, or they turn within a
        half-cycle), NOT_CLOSED (the step from the last instant back to the first is at least 99 %
        of the whole change, as in a first loading), SLIDING (|Q| >= f P at some instant), NO_STICK
        (no stick zone can carry the mean of Q, to 1e-3 of f P) or NONE (a contact does not
        exist).  Use steady_cycle for cycles out of phase, and history for load histories that are
        not cycles.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers, or the order is
        not a whole number.
    ValueError
        If the shapes of the arguments do not broadcast; if there are fewer than two instants; if
        f, E_star or a parameter of the body changes with time; or if the order is not one of 0, 1,
        2 and 3.

    Notes
    -----
    Arguments broadcast; the instants of a cycle lie along the last axis.  In a Dask array, that
    axis must be one chunk.
    """
    _demand_order(order, 0, 3)
    numbers = numbers_of(
        {"P": P, "M": M, "Q": Q, "sigma": sigma}, {"f": f, "E_star": E_star, **asked.own}
    )
    shape = shape_of(numbers)
    if any_lazy(numbers.values()):
        return over_chunks(with_options(asked.call, {"order": order}), numbers, in_time=True)
    if not shape or shape[-1] < 2:
        raise ValueError(
            f"a cycle needs at least two instants along the last axis; got shape {shape}"
        )
    *cycles, instants = shape
    with np.errstate(all="ignore"):
        loads = [numbers[name] / numbers["E_star"] for name in ("P", "M", "Q", "sigma")]
    count = math.prod(cycles)
    whole = [np.broadcast_to(v, (*cycles, instants)).reshape(count, instants) for v in loads]
    constants = [_constant(numbers[name], cycles, instants) for name in ("f", *asked.own)]
    given = np.hstack([constants[0], np.full((count, 1), float(order)), *whole])
    own = np.ascontiguousarray(np.hstack([np.empty((count, 0)), *constants[1:]]))
    out = np.empty((count, 7 * instants))
    with np.errstate(all="ignore"):
        kernel_of("slip.march.each_march")(asked.body.law, given, own, out)
    fields = out.reshape(*cycles, instants, 7)
    values = [fields[..., i].reshape(shape) for i in range(4)]
    senses = [fields[..., i].astype(np.int64).reshape(shape) for i in range(4, 7)]
    return March(*values, *senses)


def _constant(value: Any, cycles: list[int], instants: int) -> Any:
    """The values of a constant, one per cycle, as a column.

    Raises ValueError if the constant changes with time.
    """
    held = np.broadcast_to(value, (*cycles, instants)).reshape(math.prod(cycles), instants)
    if np.any((held != held[:, :1]) & ~np.isnan(held)):
        raise ValueError(
            "f, E_star and the body's parameters must not change along the last axis, which is time"
        )
    return held[:, :1]


SOLVED = (contact, contact_at_tilt)
"""Functions that are bound to a body unless it has closed formulas for them."""

CYCLE = (
    *(stick_zone, tension_threshold, closing_tension, slip_zones, slip_error),
    *(shear_change, shear, slip_range, march),
)
"""Functions that are bound to every body."""

EXPLAINING = (why,)
"""Functions that explain one cycle in words."""
