"""The curve of a body: g' and g'' between its breaks, and the parts of a contact between these.

A break is a corner, a change of formula, or the real part of a singularity beside the real axis.
Every distance from a break or an edge is carried as such and never a difference of two places.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array, at_rows, flattened

TINY = 5e-324
"""The smallest distance."""

TOGETHER = 8_192
"""Nodes and elements that are evaluated in one piece."""


class Curve(NamedTuple):
    """g' and g'' at one place, and t g''' for what asks for it: g''' may leave float64 itself.

    distance: t, from the break that was asked.
    """

    slope: Array
    curvature: Array
    change: Callable[[], Array]
    distance: Array = np.nan


Branch = Callable[..., Curve]
"""The curve at a distance t from a break, from t and the body's parameters."""


class Piece(NamedTuple):
    """The curve between two neighbouring breaks.

    from_left: at t right of the left break; None where the piece has no left end.
    from_right: at t left of the right break; None where it has no right end.
    straight: whether g'' is zero all over it.
    """

    from_left: Branch | None
    from_right: Branch | None
    straight: bool = False


class Profile(NamedTuple):
    """A body by its curve.

    breaks: places of the breaks from left to right, from the parameters.
    corners: jumps of g' at the breaks, from the parameters; zero where there is none.
    pieces: one more than breaks.
    sharp: whether g'' is infinite at a break.
    terms: how large the terms of g' are that closed formulas add up in the contact [-a, c], from a,
        c and the parameters; None where no powers cancel in them, or where there are none.
    plain: numbers of the breaks that are there for quadrature alone: closed formulas have none.
    smooth: numbers of the breaks at which g' and g'' go on without a jump.
    degree: of g'' where all pieces are polynomials, None where one is not.
    """

    breaks: Callable[..., tuple[Array, ...]]
    corners: Callable[..., tuple[Array, ...]]
    pieces: tuple[Piece, ...]
    sharp: bool = False
    terms: Callable[..., Array] | None = None
    plain: tuple[int, ...] = ()
    smooth: tuple[int, ...] = ()
    degree: int | None = None

    def places(self, /, **constants: Array) -> list[Array]:
        """The breaks that closed formulas have."""
        found = enumerate(self.breaks(**constants))
        return [place for i, place in found if i not in self.plain]


def uncut(body: Profile) -> Profile:
    """The body without the cuts that are there for quadrature of g' alone."""
    if not body.plain:
        return body
    kept: list[Piece] = []
    for i, piece in enumerate(body.pieces):
        if i - 1 in body.plain:
            piece = Piece(kept.pop().from_left, piece.from_right)
        kept.append(piece)

    def corners(**constants: Array) -> tuple[Array, ...]:
        found = enumerate(body.corners(**constants))
        return tuple(jump for i, jump in found if i not in body.plain)

    def breaks(**constants: Array) -> tuple[Array, ...]:
        return tuple(body.places(**constants))

    left = [i for i in range(len(body.pieces) - 1) if i not in body.plain]
    smooth = tuple(left.index(i) for i in body.smooth if i in left)
    made = body._replace(breaks=breaks, corners=corners, pieces=tuple(kept))
    return made._replace(plain=(), smooth=smooth)


def mirrored(body: Profile) -> Profile:
    """The body seen from behind the plane, x to the left."""

    def turned(branch: Branch | None) -> Branch | None:
        if branch is None:
            return None

        def of(t: Array, /, **constants: Array) -> Curve:
            slope, curvature, change, distance = branch(t, **constants)
            return Curve(-slope, curvature, lambda: -change(), distance)

        return of

    def breaks(**constants: Array) -> tuple[Array, ...]:
        return tuple(-place for place in reversed(body.breaks(**constants)))

    def corners(**constants: Array) -> tuple[Array, ...]:
        return tuple(reversed(body.corners(**constants)))

    pieces = tuple(
        Piece(turned(p.from_right), turned(p.from_left), p.straight) for p in reversed(body.pieces)
    )
    last = len(body.pieces) - 2
    smooth = tuple(last - i for i in body.smooth)
    return Profile(breaks, corners, pieces, body.sharp, smooth=smooth, degree=body.degree)


def slope_of(body: Profile, x: Array, /, **constants: Array) -> tuple[Array, Array]:
    """g'(x) and g''(x); at a break, of the piece on its right."""
    places = body.breaks(**constants)
    found: tuple[Array, Array] = (np.nan, np.nan)
    for i, piece in enumerate(body.pieces):
        beyond = x >= places[i - 1] if i else True
        if piece.from_left is not None:
            curve = piece.from_left(np.maximum(x - places[i - 1], TINY), **constants)
            found = np.where(beyond, curve[0], found[0]), np.where(beyond, curve[1], found[1])
        if piece.from_right is not None:
            near = x - places[i - 1] >= places[i] - x if i else True
            curve = piece.from_right(np.maximum(places[i] - x, TINY), **constants)
            here = beyond & near
            found = np.where(here, curve[0], found[0]), np.where(here, curve[1], found[1])
    return found


def corners_of(
    body: Profile, a: Array, c: Array, constants: dict[str, Array]
) -> Iterator[tuple[Array, Array, Array, Array]]:
    """Places and jumps of g', and how far each corner lies inside the left and the right edge."""
    places, jumps = body.breaks(**constants), body.corners(**constants)
    for place, jump in zip(places, jumps, strict=True):
        if np.ndim(jump) or jump != 0:
            yield place, jump, np.maximum(a + place, 0.0), np.maximum(c - place, 0.0)


class Nodes(NamedTuple):
    """Places of one part of the contact, and the curve there.

    from_low, from_high: distances from the ends of the whole window.
    from_start: distance from the part's own left end.
    start_low: of that end from the window's low end.
    ends_high: whether the part ends at the window's high end.
    """

    curve: Curve
    from_low: Array
    from_high: Array
    from_start: Array
    start_low: Array
    ends_high: Array


class Part(NamedTuple):
    """One piece inside the window [low, high], for some elements.

    left, right: the piece's breaks, or the window's end where it has none.
    length: its length in the window; 0 where it is outside.
    start_low, end_high: distances of its ends from the window's.
    beyond_left, beyond_right: distances from the piece's breaks to its ends in the window.
    """

    piece: Piece
    left: Array
    right: Array
    length: Array
    start_low: Array
    end_high: Array
    beyond_left: Array
    beyond_right: Array
    constants: dict[str, Array]

    def on(self, rows: Any) -> "Part":
        """The same for some elements."""
        own = {
            n: v[rows] for n, v in self._asdict().items() if isinstance(v, np.ndarray) and v.ndim
        }
        return self._replace(**own, constants=at_rows(rows, self.constants))

    @property
    def ends_high(self) -> Array:
        """Whether it ends at the window's high end."""
        return self.end_high == 0

    def at_high(self) -> Curve:
        """The curve at its right end."""
        return self._curve(False, self.length, 0.0)

    def beside(self, along: Array, back: Array) -> Curve:
        """The curve at distances from its left and its right end, of the nearer break.

        Negative distances are places beyond it, for a curve that has a value there.
        """
        of_left, of_right, _ = self.piece
        past, ahead = self.beyond_left + along, self.beyond_right + back
        if of_left is None:
            return of_right(ahead, **self.constants)  # type: ignore[misc]
        if of_right is None:
            return of_left(past, **self.constants)
        left, right = of_left(past, **self.constants), of_right(ahead, **self.constants)
        return _either(past <= ahead, left, right)

    def _curve(self, near_left: bool, along: Array, back: Array) -> Curve:
        """The curve at distances from its left and its right end, of its left or its right half.

        Of two breaks the nearer one is asked, where one is farther off than three times the other.
        """
        of_left, of_right, _ = self.piece
        past, ahead, length = self.beyond_left, self.beyond_right, self.length
        if of_left is None:
            return self._asked(of_right, ahead + back)
        if of_right is None:
            return self._asked(of_left, past + along)
        ours = past <= ahead + length if near_left else past + length < ahead
        if np.all(ours):
            return self._asked(of_left, past + along)
        right = self._asked(of_right, ahead + back)
        if not np.any(ours):
            return right
        return _either(ours, self._asked(of_left, past + along), right)

    def _asked(self, branch: Branch | None, distance: Array) -> Curve:
        """The curve at a distance from a break."""
        t = np.maximum(distance, TINY)
        return branch(t, **self.constants)._replace(distance=t)  # type: ignore[misc]

    def angle(self) -> Array:
        """int ds/w over it."""
        start, end = self.start_low, self.end_high
        beyond, before = start + self.length, end + self.length
        larger, smaller = np.sqrt(before * beyond), np.sqrt(end * start)
        product = (start + before) * self.length / np.maximum(larger + smaller, TINY)
        sine = np.where(smaller < larger / 4, larger - smaller, product)  # fewer roundings
        return 2 * np.arctan2(sine, np.sqrt(before * end) + np.sqrt(beyond * start))

    def at(self, near_left: bool, q: Array, rest: Array) -> Nodes:
        """Nodes at the fractions q from the left end, 1 - q = rest from the right."""
        along, back = self.length * q, self.length * rest
        curve = self._curve(near_left, along, back)
        low, high = self.start_low + along, self.end_high + back
        return Nodes(curve, low, high, along, self.start_low, self.ends_high)


def _either(first: Array, left: Curve, right: Curve) -> Curve:
    """One curve where `first`, the other elsewhere."""
    return Curve(
        np.where(first, left.slope, right.slope),
        np.where(first, left.curvature, right.curvature),
        lambda: np.where(first, left.change(), right.change()),
        np.where(first, left.distance, right.distance),
    )


class Window(NamedTuple):
    """A body and the windows [low, high] of its contact; `rows` are left to do."""

    body: Profile
    constants: dict[str, Array]
    low: Array
    high: Array
    width: Array
    rows: Any

    def on(self, rows: Any) -> "Window":
        """The same for some elements."""
        constants = at_rows(rows, self.constants)
        return Window(self.body, constants, self.low[rows], self.high[rows], self.width[rows], rows)

    def pieces(self, curved: bool = False) -> Iterator[Part]:
        """The pieces as they lie in the windows; only those that are curved, if that is asked."""
        places: Sequence[Any] = self.body.breaks(**self.constants)
        none, everywhere = 0 * self.width, np.full_like(self.width, np.inf)
        for i, piece in enumerate(self.body.pieces):
            if curved and piece.straight:
                continue
            left = places[i - 1] if i else None
            right = places[i] if i < len(places) else None
            length, span = self.width, everywhere
            if left is not None and right is not None:
                span = right - left
                length = np.minimum(length, span)
            start, past, end, ahead = none, none, none, none
            if left is not None:
                start = _between(left - self.low, self.width)
                past = _between(self.low - left, span)
                length = np.minimum(length, self.high - left)
            if right is not None:
                end = _between(self.high - right, self.width)
                ahead = _between(right - self.high, span)
                length = np.minimum(length, right - self.low)
            ends = self.low if left is None else left, self.high if right is None else right
            yield Part(
                piece, *ends, np.maximum(length, 0.0), start, end, past, ahead, self.constants
            )


def _between(value: Array, most: Array) -> Array:
    """What lies between zero and `most`; several times faster than np.clip for a few."""
    return np.minimum(np.maximum(value, 0.0), most)


class Elements:
    """Arguments along one dimension, and the way back."""

    def __init__(self, a: Array, c: Array, constants: dict[str, Array], *also: Array) -> None:
        flat, self.constants, self.shape = flattened((a, c, *also), constants)
        self.a, self.c, *self.also = flat

    def shaped(self, value: Array) -> Array:
        """A result in the shape of the arguments."""
        return value.reshape(self.shape)[()]
