"""What a contact carries where a body is straight lines and parabolas: sums that lose no digits.

A place s of the contact [-a, c], h wide, is told by its angle t,

    A = a + s = h sin(t)**2,   B = c - s = h cos(t)**2,   ds/w = 2 dt.

The part of a contact that a piece of the body covers, from t_0 to t_1, has the extent e = t_1 - t_0
and the sum T = t_0 + t_1.  Sines and cosines of both are roots of products of distances, l being
the part's length,

    sin e = l/(h sin T),                       cos e = (sqrt(A_0 A_1) + sqrt(B_0 B_1))/h,
    h sin T = sqrt(A_1 B_0) + sqrt(A_0 B_1),   h cos T = sqrt(B_0 B_1) - sqrt(A_0 A_1),

and of the extent itself one function is needed, positive, with a series:

    D = e - sin(e) cos(e) = (2/3) e**3 - (2/15) e**5 + ...

With it the integrals over a part are sums of terms of one sign, however short the part is, and
however close its ends lie to the edges.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache, wraps
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from ._arrays import TINY, Array, fmax, kink_logarithm, maximum, minimum, some
from ._state import State

AFAR = 0.75
"""A part whose nearer end is farther away from x than so many of its lengths is seen from afar."""

KEPT = 64
"""Bodies that are kept to be looked up."""

_BOW = (
    (
        *(-1.8613954732794308e-14, 2.1451333608482876e-12, -1.8422327086973616e-10),
        *(1.2529063478587505e-08, -6.577783818838708e-07),
    ),
    (
        *(2.565335895128695e-05, -0.0007054673721206159, 0.012698412698410114),
        *(-0.13333333333333314, 0.6666666666666666),
    ),
)
"""D/e**3 as a polynomial of e**2, exact to rounding up to e = pi/2."""

_EXCESS = (
    (
        *(0.0, 0.15222205279200518, -0.060024385504267745, 0.08181066285527305),
        0.03222982838448558,
    ),
    (
        *(0.049649434988923956, 0.05237790918986339, 0.05884565690504169, 0.0666653299439528),
        0.07692313148109936,
    ),
    (
        *(0.09090908947167069, 0.11111111113373036, 0.14285714285695758, 0.2000000000000006),
        0.3333333333333333,
    ),
)
"""(artanh z - z)/z**3 as a polynomial of z**2, exact to rounding up to artanh z = artanh(y)/2."""

_STRAIGHT = 1e-9
"""Below this a tangent is its angle, to rounding."""

_NOTHING = 1e-300
"""What stands for zero under a line."""

_PI = math.pi


class Parabolas(NamedTuple):
    """A body whose curve is straight lines and parabolas, with its parameters; all for E* = 1.

    kinks: places where the curve changes, from left to right.
    spans: how far each lies from the next one.
    corners: jumps of g' there, by the numbers of the kinks that are corners.
    bends: g'' of each piece between the kinks, None where it is straight.
    slopes: of each piece a place and g' there, on the piece's own line or parabola, of the same
        sign as all over it, or zero; None where g' is zero all over it.
    plain: whether all of these are known to be Python's numbers.
    """

    kinks: tuple[Array, ...]
    spans: tuple[Array, ...]
    corners: Mapping[int, Array]
    bends: tuple[Array | None, ...]
    slopes: tuple[tuple[Array, Array] | None, ...]
    plain: bool = False

    def in_numbers(self) -> "Parabolas":
        """The same in Python's numbers, whose arithmetic is quicker."""
        return Parabolas(
            tuple(map(float, self.kinks)),
            tuple(map(float, self.spans)),
            {i: float(jump) for i, jump in self.corners.items()},
            tuple(None if bend is None else float(bend) for bend in self.bends),
            tuple(line and (float(line[0]), float(line[1])) for line in self.slopes),
            plain=True,
        )

    def load(self, a: Array, c: Array) -> Array:
        """The load of the contact [-a, c]; zero where it carries none."""
        return _Contact(self, a, c).load()

    def moment(self, a: Array, c: Array) -> Array:
        """The moment."""
        return _Contact(self, a, c).moment()

    def tilt(self, a: Array, c: Array) -> Array:
        """The tilt."""
        return _Contact(self, a, c).tilt()

    def edges(self, a: Array, c: Array) -> tuple[Array, Array]:
        """K_N at the left and the right edge."""
        return _Contact(self, a, c).edges()

    def second(self, a: Array, c: Array) -> tuple[Array, Array]:
        """L_N at the left and the right edge."""
        return _Contact(self, a, c).second()

    def third(self, a: Array, c: Array) -> tuple[Array, Array]:
        """The coefficients of s**(5/2) in the pressure next to the left and the right edge."""
        return _Contact(self, a, c).third()

    def pressure(self, x: Array, a: Array, c: Array) -> Array:
        """The pressure at a place x of the contact."""
        return _Contact(self, a, c).pressure(x)

    def state(self, a: Array, c: Array) -> State:
        """Load, moment, tilt and K_N at once; a load of NaN where there is none."""
        contact = _Contact(self, a, c)
        load = contact.load()
        found = np.where((contact.h > 0) & (load > 0), load, np.nan)[()]
        return State(found, contact.moment(), contact.tilt(), *contact.edges())

    def slope(self, x: Array) -> tuple[Array, Array]:
        """g'(x) and g''(x); at a kink, of the piece on its right."""
        slope = rate = 0.0 * x
        for i, (bend, line) in enumerate(zip(self.bends, self.slopes, strict=True)):
            here = x >= self.kinks[i - 1] if i else True
            slope = np.where(here, _slope(bend, line, x), slope)
            rate = np.where(here, 0.0 if bend is None else bend, rate)
        return slope[()], rate[()]


def looked_up(build: Callable[..., Parabolas]) -> Callable[..., Parabolas]:
    """Bodies from their parameters, which are looked up where these are numbers."""

    @lru_cache(maxsize=KEPT)
    def of_numbers(**parameters: Array) -> Parabolas:
        return build(**parameters).in_numbers()

    @wraps(build)
    def body(**parameters: Array) -> Parabolas:
        try:
            return of_numbers(**parameters)
        except TypeError:  # arrays cannot be looked up
            return build(**parameters)

    return body


def _slope(bend: Array | None, line: tuple[Array, Array] | None, x: Array) -> Array:
    """g' at a place of a piece."""
    if line is None:
        return 0.0
    place, there = line
    return there if bend is None else there + bend * (x - place)


class _Part(NamedTuple):
    """The part of a contact that a piece covers.

    piece: its number.
    bend: g'' on it.
    length, sine, cosine, extent, bow: l, sin e, cos e, e and D, the last only if it was asked for.
    near, far, across: sqrt(A_0 A_1), sqrt(B_0 B_1) and h sin T.
    """

    piece: int
    bend: Array
    length: Array
    sine: Array
    cosine: Array
    extent: Array
    bow: Array
    near: Array
    far: Array
    across: Array


class _Arithmetic(NamedTuple):
    """Of numbers, or of arrays."""

    sqrt: Callable[..., Any]
    least: Callable[..., Any]
    most: Callable[..., Any]
    where: Callable[..., Any]
    arctan: Callable[..., Any]


def _either(condition: bool, value: Array, other: Array) -> Array:
    return value if condition else other


def _arctan(tangent: float) -> float:
    """Of one number; NumPy would tell of the denormal ones."""
    return tangent if tangent < _STRAIGHT else float(np.arctan(tangent))


_NUMBERS = _Arithmetic(math.sqrt, min, max, _either, _arctan)
_ARRAYS = _Arithmetic(np.sqrt, minimum, maximum, np.where, np.arctan)


class _Contact:
    """The contact [-a, c] of a body.

    Where edges and kinks are numbers, it is computed with Python's, whose arithmetic is quicker,
    and what it carries is such a number.

    inside: how far the kinks, drawn in to the contact, lie inside the left and the right edge; the
        edges before and behind them.
    """

    __slots__ = ("_curved", "a", "body", "c", "h", "inside", "kinks", "of")

    def __init__(self, body: Parabolas, a: Array, c: Array) -> None:
        numbers = body.plain and type(a) in _OF_NUMBERS and type(c) in _OF_NUMBERS
        if numbers:
            a, c = float(a), float(c)
            h = a + c if a + c > 0 else math.nan
        else:
            h = a + c
        inside = [(0.0 * h, h)]
        for kink in body.kinks:
            left, right = a + kink, c - kink
            if numbers:
                within = (0.0, h) if left <= 0 else (h, 0.0) if right <= 0 else (left, right)
            else:
                within = minimum(maximum(left, 0.0), h), minimum(maximum(right, 0.0), h)
            inside.append(within)
        inside.append((h, 0.0 * h))
        self.of = _NUMBERS if numbers else _ARRAYS
        self.body, self.kinks, self.inside = body, body.kinks, inside
        self.a, self.c, self.h = a, c, h
        self._curved: list[_Part] | None = None

    def part(self, i: int, bend: Array, with_bow: bool = True) -> _Part | None:
        """What the contact has of a piece; None where that is nothing, and a number."""
        h, of, last, sqrt = self.h, self.of, len(self.kinks), self.of.sqrt
        A_0, B_0 = self.inside[i]
        A_1, B_1 = self.inside[i + 1]
        length = A_1 if i < last else B_0
        if 0 < i < last:
            length = of.least(of.least(A_1, B_0), self.body.spans[i - 1])
        if of is _NUMBERS and not length > 0:
            return None
        across = sqrt(A_1 * B_0) + sqrt(A_0 * B_1)
        near, far = sqrt(A_0 * A_1), sqrt(B_0 * B_1)
        sine, cosine = length / (across + _NOTHING), (near + far) / h
        extent = 2 * of.arctan(sine / (1 + cosine))
        bow = _bow(extent) if with_bow else 0.0
        found = (i, bend, length, sine, cosine, extent, bow, near, far, across)
        return tuple.__new__(_Part, found)  # twice as quick as _Part(...)

    def curved(self, with_bow: bool = True) -> list[_Part]:
        """The curved parts."""
        if self._curved is None:
            self._curved = found = []
            for i, bend in enumerate(self.body.bends):
                if bend is not None and (part := self.part(i, bend, with_bow)):
                    found.append(part)
        return self._curved

    def corners(self) -> Sequence[tuple[Array, Array, Array]]:
        """Jumps of g', and how far they lie inside the left and the right edge."""
        jumps = self.body.corners
        return [(jump, *self.inside[i + 1]) for i, jump in jumps.items()] if jumps else ()

    # ------------------------------------------------------------------ what it carries

    def load(self) -> Array:
        """(1/2) int g'' w ds."""
        force = 0.0 * self.h
        for part in self.curved():
            force = force + self._force(part)
        for jump, A, B in self.corners():
            force = force + jump * self.of.sqrt(A * B)
        return force / 2

    def moment(self) -> Array:
        """-(1/2) int g'' w (s + mid)/2 ds."""
        force = arm = 0.0 * self.h
        for part in self.curved():
            (A_0, B_0), (A_1, B_1) = self.inside[part.piece : part.piece + 2]
            first, last = A_0 * B_0, A_1 * B_1
            squares = first + self.of.sqrt(first * last) + last
            arm = arm + part.bend * part.sine * (part.near - part.far) * squares / 1.5
            force = force + self._force(part)
        for jump, A, B in self.corners():
            share = jump * self.of.sqrt(A * B)
            force, arm = force + share, arm + share * (A - B)
        return (self.a - self.c) * force / 4 - arm / 8

    def _force(self, part: _Part) -> Array:
        """int g'' w ds over a part."""
        twice = 2 * part.sine * part.cosine * (part.across * part.across)
        return part.bend / 4 * (self.h * self.h * part.bow + twice)

    def tilt(self) -> Array:
        """-(1/pi) int g'/w ds."""
        lean = 0.0 * self.h
        for part in self.curved():
            i, line = part.piece, self.body.slopes[part.piece]
            start = self.of.most(-self.a, self.kinks[i - 1]) if i else -self.a
            end = self.of.least(self.c, self.kinks[i]) if i < len(self.kinks) else self.c
            hollow = part.sine * part.sine * part.sine - part.cosine * part.bow
            both = _slope(part.bend, line, start) + _slope(part.bend, line, end)
            lean = lean + part.extent * both + part.bend * (part.near - part.far) * hollow
        for i, line in enumerate(self.body.slopes):
            if line and self.body.bends[i] is None and (flank := self.part(i, 0.0, False)):
                lean = lean + 2 * flank.extent * line[1]
        return -lean / _PI

    def edges(self) -> tuple[Array, Array]:
        """(1/(pi sqrt(h))) int g'' w/A ds and the same over B."""
        left = right = 0.0 * self.h
        for part in self.curved():
            bow, twice = self.h * part.bow, 2 * part.sine
            left = left + part.bend * (bow + twice * part.far)
            right = right + part.bend * (bow + twice * part.near)
        for jump, A, B in self.corners():
            share = jump * self.of.sqrt(A * B)
            left, right = left + share / (A + _NOTHING), right + share / (B + _NOTHING)
        root = _PI * self.of.sqrt(self.h)
        return left / root, right / root

    def second(self) -> tuple[Array, Array]:
        """(1/pi) times the finite parts of int g'' r (3 + 2 r**2) ds/(6 h**(3/2)).

        r = sqrt(A/B) for the right edge.
        """
        scale = (6 * _PI) * self.h * self.of.sqrt(self.h)
        return self._next(1.5, self._rise, lambda r: r * (3 + 2 * (r * r)), scale)

    def third(self) -> tuple[Array, Array]:
        """(1/pi) times the finite parts of int g'' r (15 + 20 r**2 + 8 r**4) ds/(40 h**(5/2))."""
        scale = (40 * _PI) * (self.h * self.h) * self.of.sqrt(self.h)

        def of_corner(r: Array) -> Array:
            square = r * r
            return r * (15 + square * (20 + 8 * square))

        return self._next(2.5, self._steeper_rise, of_corner, scale)

    def _next(
        self,
        whole: float,
        rise: Callable[[_Part, Array, Array], Array],
        of_corner: Callable[[Array], Array],
        scale: Array,
    ) -> tuple[Array, Array]:
        """A coefficient of the pressure behind K_N, over `scale`.

        The g'' of the part that ends at the edge counts as that of the whole contact, for
        -`whole` pi h; those of the others as what they differ by.

        rise: half the integral over a part, over h.
        of_corner: the integrand over g''.
        """
        h, of, inside, arrays = self.h, self.of, self.inside, self.of is _ARRAYS
        bends: list[Array] = [0.0 if bend is None else bend for bend in self.body.bends]
        first, last = bends[0], bends[-1]
        for i in range(1, len(bends)):  # kinks at an edge or beyond it divide nothing
            inner_left, inner_right = inside[i][0] > 0, inside[-1 - i][1] > 0
            if arrays or not inner_left:
                first = of.where(inner_left, first, bends[i])
            if arrays or not inner_right:
                last = of.where(inner_right, last, bends[-1 - i])
        left, right = (-whole * _PI) * h * first, (-whole * _PI) * h * last
        for i, bend in enumerate(bends):
            inner_left, inner_right = inside[i][0] > 0, inside[i + 1][1] > 0
            off_left, off_right = bend - first, bend - last
            to_left = arrays or (inner_left and off_left != 0)
            to_right = arrays or (inner_right and off_right != 0)
            if not (to_left or to_right) or (part := self.part(i, bend)) is None:
                continue
            if to_left:
                share = 2 * h * off_left * rise(part, part.far, part.near)
                left = left + (np.where(inner_left, share, 0.0) if arrays else share)
            if to_right:
                share = 2 * h * off_right * rise(part, part.near, part.far)
                right = right + (np.where(inner_right, share, 0.0) if arrays else share)
        for jump, A, B in self.corners():
            root = of.sqrt(A * B)
            left = left + jump * of_corner(root / (A + _NOTHING))
            right = right + jump * of_corner(root / (B + _NOTHING))
        return left / (scale + _NOTHING), right / (scale + _NOTHING)

    def _rise(self, part: _Part, over: Array, under: Array) -> Array:
        """int (sin(t)**2 + 2 tan(t)**2) dt over a part for the right edge, r being tan(t)."""
        tangent = 2 * part.sine / (part.cosine + _NOTHING)
        hollow = tangent * (part.sine * part.sine) - 1.5 * part.bow
        return hollow + tangent * (over / (under + _NOTHING)) + part.sine * over / self.h

    def _steeper_rise(self, part: _Part, over: Array, under: Array) -> Array:
        """int (3 sin(t)**2 + 12 tan(t)**2 + 8 tan(t)**4) dt, T = tan e and P = tan t_0 tan t_1:

        3 int (sin(t)**2 + 2 tan(t)**2) dt + 6 T P + 8 T P**2 + (8/3) T**3 (1 + P)**3
        - 2 (T - e).
        """
        tangent, product = part.sine / (part.cosine + _NOTHING), over / (under + _NOTHING)
        rise = tangent * (1 + product)
        excess = tangent * (part.sine * part.sine) - part.bow
        steep = 2 * tangent * product * (3 + 4 * product) + (8 / 3) * (rise * rise * rise)
        return 3 * self._rise(part, over, under) + steep - 2 * excess

    def pressure(self, x: Array) -> Array:
        """(1/pi) int g'' L(x, s) ds."""
        place = _Place(self, x)
        total = 0.0 * place.root
        if place.of is _NUMBERS and place.root == 0:
            return total
        for part in self.curved(with_bow=False):
            total = total + part.bend * place.share(part)
        for i, jump in self.body.corners.items():
            total = total + jump * place.level(i + 1)
        return total / _PI


class _Place:
    """A place x of a contact; one beyond an edge is drawn in to it.

    left, right, root: its distances from the edges, and w(x).
    offsets: how far the ends of the pieces, and the edges before and behind them, lie right of it.
    """

    __slots__ = ("_levels", "contact", "left", "of", "offsets", "right", "root")

    def __init__(self, contact: _Contact, x: Array) -> None:
        a, c, of = contact.a, contact.c, _ARRAYS
        if contact.of is _NUMBERS and type(x) in _OF_NUMBERS:
            of, x = _NUMBERS, float(x)
        x = of.least(of.most(x, -a), c)
        left, right = a + x, c - x
        offsets: list[Array] = [-left]
        for kink in contact.kinks:
            offsets.append(kink - x)
        offsets.append(right)
        self.contact, self.of, self.offsets = contact, of, offsets
        self.left, self.right, self.root = left, right, of.sqrt(left * right)
        self._levels: list[Array] = [None] * len(offsets)
        self._levels[0] = self._levels[-1] = 0.0

    def level(self, i: int) -> Array:
        """L(x, s) at the end of a piece; zero for one that is not in the contact."""
        if self._levels[i] is None:
            (A, B), twice = self.contact.inside[i], 2 / self.contact.h
            if self.of is _NUMBERS and not (A > 0 and B > 0):
                return 0.0
            left, right = self.left * (B * twice), self.right * (A * twice)
            least = 0.0 if i - 1 in self.contact.body.corners else TINY
            found = kink_logarithm(left, right, self.offsets[i], least)
            self._levels[i] = float(found) / 2 if self.of is _NUMBERS else fmax(found, 0.0) / 2
        return self._levels[i]

    def arm(self, i: int) -> Array:
        """(s - x) L(x, s) there."""
        offset = self.offsets[i]
        return self.of.where(offset == 0, 0.0, offset * self.level(i))

    def share(self, part: _Part) -> Array:
        """int L(x, s) ds over a part: by parts, or where x lies far from it, from afar."""
        i, of, limit = part.piece, self.of, AFAR * part.length
        start, end = self.offsets[i], self.offsets[i + 1]
        own = part[2:6]  # length, sine, cosine and extent
        if of is _NUMBERS:
            if start > limit:
                A, B = self.contact.inside[i]
                return _from_afar(of, start, math.sqrt(A * B), self.level(i + 1), self.root, own)
            if -end > limit:
                A, B = self.contact.inside[i + 1]
                return _from_afar(of, -end, math.sqrt(A * B), self.level(i), self.root, own)
            return self._by_parts(part)
        found, afar, before = self._by_parts(part), (start > limit) | (-end > limit), start > 0
        if not some(afar):
            return found
        near, other = (self.of.sqrt(A * B) for A, B in self.contact.inside[i : i + 2])
        seen = (
            np.where(before, start, -end),
            np.where(before, near, other),
            np.where(before, self.level(i + 1), self.level(i)),
            self.root,
        )
        if type(found) is not np.ndarray:
            return np.where(afar, _from_afar(of, *seen, own), found)
        found = np.ascontiguousarray(found)
        rows = np.flatnonzero(np.broadcast_to(afar, found.shape))

        def of_rows(value: Array) -> Array:
            return np.broadcast_to(value, found.shape).ravel()[rows] if np.ndim(value) else value

        distance, near, level, root = map(of_rows, seen)
        own = tuple(map(of_rows, own))
        found.reshape(-1)[rows] = _from_afar(of, distance, near, level, root, own)
        return found

    def _by_parts(self, part: _Part) -> Array:
        """[(s - x) L(x, s)] + w(x) e, nothing of which is subtracted where x lies on the part."""
        found = self.root * part.extent
        if part.piece:  # at the edges L is zero
            found = found - self.arm(part.piece)
        if part.piece + 2 < len(self.offsets):
            found = found + self.arm(part.piece + 1)
        return found


def _from_afar(
    of: _Arithmetic,
    distance: Array,
    near: Array,
    level: Array,
    root: Array,
    own: Sequence[Array],
) -> Array:
    """int L(x, s) ds over a part whose nearer end lies d > (3/4) l away from x, l long itself,

        l L + w(x) (e - tan e + w tan(e)**2/(d + w tan e)) - d (artanh y - y),
        y = w(x) tan(e)/(d + w tan e) < sqrt(4/7),

    w = `near` at that end, and L = `level` at the other one.

    own: l, sin e, cos e and e.
    """
    length, sine, cosine, extent = own
    tangent = sine / cosine
    reach = distance + near * tangent
    y = root * tangent / reach
    z = y / (1 + of.sqrt(abs((1 - y) * (1 + y))))  # artanh y = 2 artanh z
    square = z * z
    excess = 2 * (square * z) * _polynomial(_EXCESS, square) + y * square
    turned = near * (tangent * tangent) / reach - (tangent * (sine * sine) - _bow(extent))
    return length * level + root * turned - distance * excess


def _bow(extent: Array) -> Array:
    """D of an extent."""
    square = extent * extent
    return extent * square * _polynomial(_BOW, square)


def _polynomial(coefficients: Sequence[Sequence[float]], z: Array) -> Array:
    """A polynomial of z, its coefficients from the highest on, five by five, zeros in front.

    Of a number five steps in one line are quicker than one in each of five.
    """
    if type(z) is not np.ndarray:
        total: Array = 0.0
        for p, q, r, s, t in coefficients:
            total = ((((total * z + p) * z + q) * z + r) * z + s) * z + t
        return total
    highest, *others = filter(None, chain.from_iterable(coefficients))
    total = highest * z
    for coefficient in others[:-1]:  # in place
        total += coefficient
        total *= z
    total += others[-1]
    return total


_OF_NUMBERS = (np.float64, float, int)
