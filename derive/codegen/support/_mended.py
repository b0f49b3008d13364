"""Closed formulas where they keep their digits, and quadrature where they would lose them.

Two things tell where.  A kink close to an edge or to the next one, or powers of places that cancel,
are seen before: what the pieces carry is a small difference then.  And where the terms of a formula
are many times as large as what they add up to, digits are gone.
"""

from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from functools import wraps
from itertools import pairwise
from typing import Any

import numpy as np

from ._arrays import Array, at_rows, minimum, only_where, some
from ._profile import Elements, Profile, slope_of
from ._quadrature import pressure_at, second_of, state_of

CLOSE = 0.1
"""Breaks closer than this, compared with the width, are left to quadrature."""

NEARER = 1e-2
"""For integrands only those closer than this, and only where terms cancel."""

FAR = 100.0
"""So are breaks in the contact that lie so many widths from the origin,"""

CANCELLED, TOLD = 10.0, 100.0
"""and terms so many times larger than what the slope rises by in a contact; in integrands more."""

LOST = {"moment": 8.0, "p": 8.0}
"""Terms that are so many times as large as their sum have lost digits; others four times."""

_integrated = ContextVar("integrated", default=False)
"""Whether pressures are asked for as integrands."""


def mended_sums(
    sums: Mapping[str, Sequence[Array]],
    exists: Array,
    scale: Array,
    body: Profile,
    a: Array,
    c: Array,
    /,
    x: Array = 0.0,
    **constants: Array,
) -> list[Array]:
    """Closed formulas to their last digits: like `mended`, and where their terms cancel, too.

    Arrays of other libraries keep what closed formulas give them there: none of their elements is
    integrated.

    sums: the terms of each value by its field.
    """
    values = [sum(terms[1:], terms[0]) for terms in sums.values()]
    rough = is_delicate(body, a, c, **constants)
    if not _integrated.get() and all(isinstance(v, np.ndarray | np.float64) for v in values):
        for value, (field, terms) in zip(values, sums.items(), strict=True):
            size = sum(map(np.abs, terms[1:]), np.abs(terms[0]))
            rough = rough | (size > LOST.get(field, 4.0) * np.abs(value))
    values = only_where(exists, *values) if len(values) > 1 else [only_where(exists, *values)]
    return _replaced(values, exists & rough, [*sums], scale, body, a, c, x, **constants)


def mended(
    values: Sequence[Array],
    exists: Array,
    fields: Sequence[str],
    scale: Array,
    body: Profile,
    a: Array,
    c: Array,
    /,
    **constants: Array,
) -> list[Array]:
    """Values of closed formulas, by quadrature instead where a break or a power loses their digits.

    exists: where there is a contact.
    fields: of a State; or "p", or "second_left" and "second_right".
    scale: what the quadrature is multiplied by.
    """
    rough = exists & is_delicate(body, a, c, **constants)
    return _replaced(values, rough, fields, scale, body, a, c, 0.0, **constants)


def _replaced(
    values: Sequence[Array],
    rough: Array,
    fields: Sequence[str],
    scale: Array,
    body: Profile,
    a: Array,
    c: Array,
    x: Array,
    /,
    **constants: Array,
) -> list[Array]:
    """The values, those of `rough` elements by quadrature."""
    if not some(rough):
        return [*values]
    given = Elements(a, c, constants, x, scale, rough, *values)
    x, scale, rough, *values = given.also
    rows = np.flatnonzero(rough)
    held = at_rows(rows, given.constants)
    a, c = given.a[rows], given.c[rows]
    if "p" in fields:
        found: Any = (pressure_at(body, x[rows], a, c, **held),)
    elif "second_left" in fields:
        found = second_of(body, a, c, **held)
    else:
        now = state_of(body, a, c, fields, **held)
        found = [getattr(now, name) for name in fields]
    whole = []
    for value, fresh in zip(values, found, strict=True):
        value = value.copy()
        value[rows] = scale[rows] * fresh
        whole.append(given.shaped(value))
    return whole


def as_integrand(function: Callable[..., Array]) -> Callable[..., Array]:
    """The same function, to be integrated: many times as fast, and exact to 14 digits of its mean.

    Close to an edge, where digits are lost because a break is near, there is little to integrate.
    """

    @wraps(function)
    def nearly(*args: Array, **constants: Array) -> Array:
        before = _integrated.set(True)
        try:
            return function(*args, **constants)
        finally:
            _integrated.reset(before)

    return nearly


def is_delicate(body: Profile, a: Array, c: Array, /, **constants: Array) -> Array:
    """Whether closed formulas lose digits, because what the pieces carry is a small difference.

    A break lies close to an edge, or to the next one, compared with the width; or powers cancel, or
    the moment about a break is small beside that about the origin.
    """
    h, places, integrated = a + c, body.places(**constants), _integrated.get()
    least = (NEARER if integrated else CLOSE) * h
    rough = h < 0
    for place in places:
        near = minimum(a + place, c - place)
        close, far = least, abs(place) > FAR * h
        if some(far):
            close = np.where(far, np.inf, close)
        rough = rough | ((near >= 0) & (near < close))
    for left, right in pairwise(places):
        rough = rough | ((right - left < least) & (left > -a) & (right < c))
    if integrated and some(rough):
        rough = _is_lost(body, rough, a, c, constants)
    if body.terms is not None:
        rise = slope_of(body, c, **constants)[0] - slope_of(body, -a, **constants)[0]
        allowed = TOLD if integrated else CANCELLED
        rough = rough | ~(body.terms(a, c, **constants) < allowed * rise)
    return rough


def _is_lost(body: Profile, rough: Array, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    """Which of the `rough` elements lose too much for an integrand, too.

    Terms are as large as the width times the largest curvature; they add up to no less than what
    the slope rises by in the contact.
    """
    given = Elements(a, c, constants, rough)
    rows = np.flatnonzero(given.also[0])
    a, c, held = given.a[rows], given.c[rows], at_rows(rows, given.constants)
    left, right = (slope_of(body, x, **held) for x in (-a, c))
    bend = np.maximum(left[1], right[1])
    for place in body.breaks(**held):
        for x in (np.nextafter(place, -np.inf), np.nextafter(place, np.inf)):
            curvature = slope_of(body, x + 0 * a, **held)[1]
            bend = np.where((x > -a) & (x < c), np.maximum(bend, curvature), bend)
    lost = np.full(given.a.shape, False)
    lost[rows] = ~((a + c) * bend < TOLD * (right[0] - left[0]))
    return given.shaped(lost)
