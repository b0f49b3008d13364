"""Functions of a body that are solved for: contacts from loads, stick zones, slip, shear, a march.

What a person gives follows the `Asked`, which knows the body; `Body.bound` makes the public
function of it and completes its docstring.  The kernels are loaded when they are first needed.
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
    """The edges of a Contact by their names in messages.

    Raises TypeError for what is no Contact.
    """
    try:
        return {f"{label}.a": contact.a, f"{label}.c": contact.c}
    except AttributeError:
        raise TypeError(
            f"{label} must be a Contact, as contact(...) gives it; got {contact!r:.60}"
        ) from None


def _between(first: Any, second: Any, **others: Any) -> dict[str, Any]:
    return _edges_of(first, "first") | _edges_of(second, "second") | others


def _demand_order(order: Any, least: int, most: int) -> None:
    """Raises TypeError for what is no whole number, ValueError for an order that there is not."""
    if isinstance(order, bool) or not isinstance(order, int | np.integer):
        raise TypeError(f"order must be a whole number; got {order!r:.60}")
    if not least <= order <= most:
        raise ValueError(f"order must be {least} to {most}; got {order}")


# ---------------------------------------------------------------- what a contact carries


class _State(NamedTuple):
    """What a contact carries."""

    load: Array
    moment: Array
    tilt: Array
    left: Array
    right: Array


class _Series(NamedTuple):
    """Slip zones, and the errors estimated of them."""

    left: Array
    right: Array
    error_left: Array
    error_right: Array


def integrated(asked: Asked, a: Array, c: Array, *, E_star: Array = 1.0, x: Array = None) -> Any:
    """What a contact carries by quadrature: the one function of a body that was called.

    The module says in its docstring which integral that is.
    """
    name = asked.call.__name__
    place = {"x": x} if name == "pressure" else {}
    given = {**place, "a": a, "c": c}
    constants = {} if name == "tilt" else {"E_star": E_star}
    loop, kind = {"pressure": ("pressure", None), "L_N": ("series", _Series)}.get(
        name, ("state", _State)
    )
    found = asked.solved(
        f"forward.each_{loop}", given, constants, tuple(given), kind, by_modulus=name != "tilt"
    )
    if name in ("K_N", "L_N"):
        return found if isinstance(found, Edges) else Edges(found.left, found.right)
    return getattr(found, name, found)


# ---------------------------------------------------------------- contacts from loads


def contact(asked: Asked, P: Array, M: Array = 0.0, *, E_star: Array) -> Contact:
    """Contact and tilt under the load P and the moment M.

        P = load(a, c), M = moment(a, c); solved for a and c by Newton's method
        alpha = tilt(a, c)

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Contact
        a [m], c [m], alpha [rad].  NaN unless P > 0, E_star > 0, the body's own parameters
        are positive and there is a contact.  The derivatives follow from K_N: a contact
        grows by flat punches.
    """
    given, loads = {"P": P, "M": M}, ("P", "M")
    return asked.solved(
        "inverse.each_contact", given, {"E_star": E_star}, loads, Contact, over_modulus=loads
    )


def contact_at_tilt(asked: Asked, P: Array, alpha: Array = 0.0, *, E_star: Array) -> Contact:
    """Contact under the load P at the tilt alpha.

        P = load(a, c), alpha = tilt(a, c); solved for a and c by Newton's method

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Contact
        a [m], c [m], alpha as given.  NaN unless P > 0, E_star > 0, the body's own
        parameters are positive and there is a contact.  The derivatives follow from K_N: a
        contact grows by flat punches.
    """
    return asked.solved(
        "inverse.each_contact_at_tilt",
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
    """What sticks all through a steady cycle, [-m, n], and how the cycle slips.

        moderate tension: load(m, n) = (P1 + P2)/2 - dQ/(2 f),
            tilt(m, n) = (alpha1 + alpha2)/2 - dsigma/(4 f E*)
        large tension: int r sqrt((xi + m)/(xi - n)) dxi = dQ - pi dsigma (m + n)/8,
            int r sqrt((xi - n)/(xi + m)) dxi = dQ + pi dsigma (m + n)/8 over the slip zones,
            r = +/- f (p1 + p2), the upper sign on the left if dsigma > 0

    Parameters
    ----------
    {arguments}

    Returns
    -------
    StickZone
        m [m], n [m], regime as a code of Regime.  NaN unless the regime is MODERATE, LARGE
        or FULL_STICK; where slip reverses within a half-cycle, MIXED, they are given if the
        normal loads are constant and forward slip overtakes it in the end, or if `mixed`
        asks for them, and where dQ < 0 or dQ >= f (P1 + P2), which is sliding. steady_cycle
        answers every cycle, with an estimate of its error where that is computed.
    """
    if not isinstance(mixed, bool | np.bool_):
        raise TypeError(f"mixed must be True or False, for all cycles; got {mixed!r:.60}")
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

    Parameters
    ----------
    {arguments}

    Returns
    -------
    str
        All that is wrong with the numbers where the regime is NONE.

    Raises
    ------
    ValueError
        For arrays.

    Notes
    -----
    One cycle at a time: every argument is a number.
    """
    zone = stick_zone(asked, first, second, dQ, dsigma, f=f, E_star=E_star)
    if np.ndim(zone.regime):
        raise ValueError(f"why takes one cycle, in numbers; got arrays of {np.shape(zone.regime)}")
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
    """Changes of bulk tension between which tension is moderate, so that its solution is exact.

        constant loads: dsigma = -/+ 8 dQ/(pi (a + c))

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Threshold
        lower [Pa], upper [Pa].  NaN unless there is such a range, and where dQ < 0 or dQ >=
        f (P1 + P2), which is sliding.
    """
    return _tensions(asked, "tension_threshold", first, second, dQ, f, E_star)


def closing_tension(
    asked: Asked, first: Contact, second: Contact, dQ: Array, *, f: Array, E_star: Array
) -> Threshold:
    """Changes of bulk tension at which the moderate solution closes one slip zone.

        upper: load(m, c) = (P1 + P2)/2 - dQ/(2 f),
            dsigma = 4 f E* ((alpha1 + alpha2)/2 - tilt(m, c)), c that of the smaller contact
        lower: the same with a kept

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Threshold
        lower [Pa], upper [Pa]. slip reverses before it closes, see tension_threshold.  NaN
        unless the reduced load is positive, and where dQ < 0 or dQ >= f (P1 + P2), which is
        sliding.
    """
    return _tensions(asked, "closing_tension", first, second, dQ, f, E_star)


def _tensions(
    asked: Asked, name: str, first: Any, second: Any, dQ: Array, f: Array, E_star: Array
) -> Threshold:
    found: Threshold = asked.solved(
        f"slip.threshold.each_{name}",
        _between(first, second, dQ=dQ),
        {"f": f, "E_star": E_star},
        (*_BOTH, "dQ", "f"),
        Threshold,
        over_modulus=("dQ",),
        by_modulus=True,
    )
    return found


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
    """Slip zones by series in their length.

        order 1: d = |K_T|/(f K_N) + da/2, and dc/2 at the right edge
        orders 2 and 3: the conditions of stick_zone for the pressure's first two or three terms
            at each edge of both contacts, cut behind that power of d, solved as they stand

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Edges
        left [m], right [m].  NaN unless slip reaches in at both edges and leaves some
        stick, and where dQ < 0 or dQ >= f (P1 + P2), which is sliding.
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
    """By how much one more term would change the slip zones: an estimate of the series' error.

        |d(order + 1) - d(order)|

    Parameters
    ----------
    {arguments}

    Returns
    -------
    Edges
        left [m], right [m].  NaN unless both orders give slip zones, and where dQ < 0 or dQ
        >= f (P1 + P2), which is sliding.
    """
    given = {"a": a, "c": c, "dQ": dQ, "dsigma": dsigma, "da": da, "dc": dc}
    _demand_order(order, 1, 2)
    return _series(asked, given, f, E_star, order, 2)


def _series(
    asked: Asked, given: dict[str, Any], f: Array, E_star: Array, order: int, first: int
) -> Edges:
    """Slip zones (first = 0) or their errors (first = 2)."""
    found = asked.solved(
        "slip.series.each_slip_zones",
        given,
        {"f": f, "E_star": E_star},
        ("a", "c", "dQ", "dsigma", "f", "da", "dc"),
        _Series,
        over_modulus=_LOADS,
        options={"order": order},
    )
    return found if isinstance(found, Edges) else Edges(*found[first : first + 2])


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
    """Change of the shear traction at x over the half-cycle; zero outside the contacts.

        dq = kappa f (p1 + p2) where it slips
        moderate tension: dq = f (p1 + p2) - 2 f p(x; m, n)
        large tension: dq = sqrt((x + m)(n - x))/pi int r/(w (xi - x)) dxi where it sticks,
            w = sqrt((xi + m)(xi - n)), negative on the left

    Parameters
    ----------
    {arguments}

    Returns
    -------
    dq : ndarray
        [Pa]; with `second`, dQ and dsigma as they are part of the way, dq until then, if
        the regime of the whole half-cycle is MODERATE or LARGE. NaN unless the stick zone
        is known without `mixed`, in full stick between two contacts, and where dQ < 0 or dQ
        >= f (P1 + P2), which is sliding.
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
    """How far the surfaces slip at x over the half-cycle; zero where they stick.

        (E*/2) d slip/dx = (1/pi) PV int dq/(x - xi) dxi - dsigma/4
        moderate tension and constant loads: 2 f times the gap beside the patch [-m, n]

    Parameters
    ----------
    {arguments}

    Returns
    -------
    slip : ndarray
        [m], positive.  NaN unless x lies in both contacts and the regime is MODERATE, LARGE
        or FULL_STICK, and where dQ < 0 or dQ >= f (P1 + P2), which is sliding.
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
    """The stick zone is solved for once a cycle, however many places are asked for."""
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
    """The stick zone of a cycle by the names of its fields, each with a label behind it."""
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

        q = dq(2 Q, 2 sigma)/2 - dq(dQ, dsigma), dq as by shear_change
        first the shear load rises from nothing to Q and the tension to sigma, in proportion;
            since then they have fallen by dQ and dsigma, in proportion again: by nothing at the
            upper end of a cycle, by all of the half-cycle's change at the lower end, from which
            q rises by shear_change

    Parameters
    ----------
    {arguments}

    Returns
    -------
    q : ndarray
        [Pa]; where it sticks, the mean of both ends is what the first rise has locked in.
        NaN unless the regimes of (2 Q, 2 sigma) and of (dQ, dsigma) are both MODERATE or
        both LARGE, it slips back only where it slipped and drives none of that on, and dQ
        <= 2 Q; so reverse all signs, those of q too, where the lower end has the larger
        shear load.  NaN, too, where Q < 0 or dQ < 0, and where Q >= f P, which is sliding.
    """
    given = {"x": x, **_edges_of(contact, "contact"), "Q": Q, "sigma": sigma}
    given |= {"dQ": dQ, "dsigma": dsigma}
    constants = {"f": f, "E_star": E_star}
    if not any_lazy([*given.values(), *constants.values(), *asked.own.values()]):
        twice = 2 * numbers_of({"Q": Q}, {})["Q"], 2 * numbers_of({"sigma": sigma}, {})["sigma"]
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
    """A steady cycle instant by instant: contact, stick zone, and which way the edges slip.

        since the loads last turned, at the least or the greatest Q, slip has grown as in a
            half-cycle that ends now: by stick_zone, or by slip_zones if an order is given; where
            the whole half-cycle is MIXED it has not, and only its end may be known

    Parameters
    ----------
    {arguments}

    Returns
    -------
    March
        a, c, m, n [m]; left, right: +1 forward slip, -1 reverse slip, 0 none; regime.  A
        whole cycle is NaN, and its regime says why: OUT_OF_PHASE unless all loads are as
        far on their way between both states at every instant, to 1e-6 of their change;
        NOT_CLOSED unless the last instant leads back to the first; SLIDING where |Q| >= f P
        at any instant; NONE where a contact does not exist.  For cycles out of phase
        steady_cycle, for what is no cycle history.

    Notes
    -----
    Arguments broadcast; the instants of a cycle lie along the last axis.  Of a Dask array, that
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
            f"a cycle has two instants or more, along the last axis; got shape {shape}"
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
    found = out.reshape(*cycles, instants, 7)
    values = [found[..., i].reshape(shape) for i in range(4)]
    senses = [found[..., i].astype(np.int64).reshape(shape) for i in range(4, 7)]
    return March(*values, *senses)


def _constant(value: Any, cycles: list[int], instants: int) -> Any:
    """One value a cycle of a constant, as a column.

    Raises ValueError where it changes in time.
    """
    held = np.broadcast_to(value, (*cycles, instants)).reshape(math.prod(cycles), instants)
    if np.any((held != held[:, :1]) & ~np.isnan(held)):
        raise ValueError("f, E_star and the body's parameters must not change along the last axis")
    return held[:, :1]


SOLVED = (contact, contact_at_tilt)
"""What a body has closed formulas of, or not."""

CYCLE = (
    *(stick_zone, tension_threshold, closing_tension, slip_zones, slip_error),
    *(shear_change, shear, slip_range, march),
)
"""What every body is bound to."""

EXPLAINING = (why,)
"""What tells of one cycle in words."""
