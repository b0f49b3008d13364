"""Functions of the parts of a contact, each of which lies on one piece of a polynomial body.

A point s of the contact [-a, c] of width h has an angle on the semicircle over the contact,
2 atan2(sqrt(a + s), sqrt(c - s)), from 0 at the left edge to pi at the right one.  A part subtends
an angle t, the difference of the angles of its ends.  Sines and cosines of half angles are square
roots of distances,

    sin = sqrt((a + s)/h),    cos = sqrt((c - s)/h).

Every result is computed as a sum of positive terms, or is expanded in a series where its terms
would cancel.  All functions accept numbers or arrays; the versions for numbers are compiled.
"""

from math import factorial

import numpy as np

from .elementary import NOTHING
from .kernels import shared, where
from .types import Array

_NEAR, _WIDE = 0.5, 1.0
"""A part is distant if its logarithms differ by less than artanh of the first number and half its
angle is below the second.  Otherwise no terms cancel in the integration by parts."""

_SEGMENT = tuple((-1) ** n * 4.0 ** (n + 1) / factorial(2 * n + 3) for n in range(12, -1, -1))
"""segment(t)/t**3 = sum (-1)**n 4**(n + 1)/(2 n + 3)! t**(2 n), from the highest power down."""

_INVOLUTE = tuple((-1) ** n * (2.0 * n + 2) / factorial(2 * n + 3) for n in range(12, -1, -1))
"""involute(t)/t**3 = sum (-1)**n (2 n + 2)/(2 n + 3)! t**(2 n), from the highest power down."""

_EXCESS = tuple(1 / (2.0 * n + 3) for n in range(13, -1, -1))
"""(artanh(z) - z)/z**3 = sum z**(2 n)/(2 n + 3), from the highest power down."""


@shared
def polynomial(coefficients: tuple[float, ...], z: Array) -> Array:
    """A polynomial of z, with the coefficient of its highest power first."""
    total = 0.0 * z
    for coefficient in coefficients:
        total = total * z + coefficient
    return total


@shared
def segment(t: Array) -> Array:
    """t - sin(t) cos(t), 0 <= t <= pi: the area of a segment of the unit circle of angle 2 t.

    For t < 1: (2/3) t**3 - (2/15) t**5 + (4/315) t**7 - ...

    >>> float(segment(np.pi))
    3.141592653589793
    """
    square = t * t
    series = t * square * polynomial(_SEGMENT, square)
    return where(t < 1.0, series, t - np.sin(t) * np.cos(t))


@shared
def involute(t: Array) -> Array:
    """sin(t) - t cos(t), 0 <= t <= pi: the lateral coordinate of the involute of the unit circle.

    For t < 3/2: (1/3) t**3 - (1/30) t**5 + (1/840) t**7 - ...

    >>> float(involute(np.pi))
    3.141592653589793
    """
    square = t * t
    series = t * square * polynomial(_INVOLUTE, square)
    return where(t < 1.5, series, np.sin(t) - t * np.cos(t))


@shared
def edge_angle(within: Array, beyond: Array) -> Array:
    """2 atan2(sqrt(within), sqrt(beyond)), the angle of a part at an edge; negatives count as 0.

    >>> float(edge_angle(1.0, -1.0))
    3.141592653589793
    """
    return 2 * np.arctan2(np.sqrt(np.maximum(within, 0.0)), np.sqrt(np.maximum(beyond, 0.0)))


@shared
def part_area(t: Array, across: Array) -> Array:
    """int w ds divided by h**2/8, for a part between two kinks.

    It is 2 segment(t/2) + 2 sin(t) across**2.

    t: the angle of the part, 0 <= t <= pi.
    across: the sine of half the sum of the angles of its ends.

    >>> f"{part_area(np.pi, 1.0):.6g}"
    '3.14159'
    """
    return 2 * segment(t / 2) + 2 * np.sin(t) * (across * across)


@shared
def part_arm(t: Array, sine_1: Array, cosine_1: Array, sine_2: Array, cosine_2: Array) -> Array:
    """int w (s - mid) ds divided by h**3/24, for a part between two kinks.

    t: the angle of the part.
    sine_1, ..., cosine_2: sines and cosines of half the angles of its ends.

    >>> float(part_arm(np.pi, 0.0, 1.0, 1.0, 0.0))
    0.0
    """
    first, last = sine_1 * cosine_1, sine_2 * cosine_2
    squares = first * first + first * last + last * last
    return 8 * np.sin(t / 2) * (sine_1 * sine_2 - cosine_1 * cosine_2) * squares


@shared
def part_weight(t: Array, far: Array) -> Array:
    """int w/A ds/h, for a part between two kinks: segment(t/2) + 2 sin(t/2) far.

    t: the angle of the part.
    far: the product of the cosines of half the angles of its ends; of the sines for the right edge.

    >>> float(part_weight(np.pi, 0.0)) / (np.pi / 2)
    1.0
    """
    return segment(t / 2) + 2 * np.sin(t / 2) * far


@shared
def excess(y: Array) -> Array:
    """artanh(y) - y, 0 <= y <= 1/2.

    With z = y/(1 + sqrt(1 - y**2)) it is 2 (artanh(z) - z) + y z**2, and
    artanh(z) - z = z**3/3 + z**5/5 + z**7/7 + ...

    >>> float(excess(0.0))
    0.0
    """
    z = y / (1 + np.sqrt(np.maximum((1 - y) * (1 + y), 0.0)))
    square = z * z
    return 2 * (z * square) * polynomial(_EXCESS, square) + y * square


@shared
def root_ratio(numerator: Array, denominator: Array) -> Array:
    """sqrt(numerator/denominator); zero unless both are positive, as they are inside the contact.

    >>> float(root_ratio(4.0, 1.0)), float(root_ratio(4.0, 0.0))
    (2.0, 0.0)
    """
    inside = (numerator > 0) & (denominator > 0)
    quotient = np.maximum(numerator, 0.0) / np.maximum(denominator, NOTHING)
    return where(inside, np.sqrt(quotient), 0.0)


@shared
def second_term(t: Array, near: Array, far: Array) -> Array:
    """int (sin(v)**2 + 2 tan(v)**2) dv over the half angles of a part, for the right edge.

    t: the angle of the part, 0 <= t < pi.
    near, far: the product of the sines, and of the cosines, of the half angles of its ends;
        exchanged for the left edge.  The result is zero if far = 0: the part ends at the edge.

    With e = t/2, cos(e) = near + far and X = sin(e)/far, the difference of the tangents, it is

        2 (X - e) + segment(e)/2 + near sin(e),   X - e = (near X + involute(e))/(near + far),

    which tends to t**3/4 as near -> 0, for a part that begins at the left edge.

    >>> float(second_term(0.0, 0.5, 0.5))
    0.0
    """
    e = t / 2
    sine = np.sin(e)
    beyond = _beyond(e, sine, near, far)
    return where(far > 0, 2 * beyond + segment(e) / 2 + near * sine, 0.0)


@shared
def _beyond(e: Array, sine: Array, near: Array, far: Array) -> Array:
    """X - e: the difference of two tangents less the difference of their angles."""
    cosine = np.maximum(near + far, NOTHING)
    return (near * (sine / np.maximum(far, NOTHING)) + involute(e)) / cosine


@shared
def end_pressure(t: Array, sine: Array, cosine: Array) -> Array:
    """int L ds/h over the part between an edge and a kink, seen from x.

    t: the angle of the part, 0 <= t <= pi.
    sine, cosine: of half the angle of x, both measured from the part's edge: square roots of the
        distances of x from that edge and from the other one, over h.

    With e = t/2 and f, half the angle of x,

        e sin(f) cos(f) + (sin(e)**2 - sin(f)**2) artanh(y),   y = tan(e)/tan(f) or its inverse,

    a sum of positive terms if x lies on the part.  If x lies outside, and y < 1/2 and e < 1,

        sin(e)**2 y - sin(f) cos(f) involute(e)/cos(e) - (sin(f)**2 - sin(e)**2) excess(y).

    >>> float(end_pressure(np.pi, 1.0, 1.0)) / (np.pi / 2)
    1.0
    """
    e = t / 2
    sine_e, cosine_e = np.sin(e), np.maximum(np.cos(e), NOTHING)
    p, q, root = sine_e * cosine, cosine_e * sine, sine * cosine
    offset = (p - q) * (p + q)
    y = np.minimum(p / np.maximum(q, NOTHING), _NEAR)
    level = np.log1p(2 * np.minimum(p, q) / np.maximum(np.abs(p - q), NOTHING)) / 2
    by_parts = e * root + offset * level
    afar = sine_e * sine_e * y - root * (involute(e) / cosine_e) + offset * excess(y)
    return where((p < _NEAR * q) & (e < _WIDE), afar, by_parts)


@shared
def part_pressure(
    t: Array,
    start: Array,
    end: Array,
    sine_1: Array,
    cosine_1: Array,
    sine_2: Array,
    cosine_2: Array,
    sine: Array,
    cosine: Array,
) -> Array:
    """int L ds/h over the part between two kinks, seen from x.

    t: the angle of the part, 0 <= t <= pi.
    start, end: positions of its ends relative to x, positive to the right, over h.
    sine_1, ..., cosine: of the half angles of its ends and of x.

    With L_1 and L_2 at its ends it is

        (t/2) sin(f) cos(f) + end L_2 - start L_1,   L = artanh of the ratio of the tangents,

    a sum of positive terms if x lies on the part.  If x lies outside, let d be the distance of the
    nearer end, w_1 its sine times its cosine, l the length of the part, L its value at the farther
    end, e = t/2 and w = sin(f) cos(f).  For y < 1/2 and e < 1 it is

        l L + (w/cos(e)) (w_1 sin(e)**2/(d cos(e) + w_1 sin(e)) - involute(e)) - d excess(y),
        y = w sin(e)/(d cos(e) + w_1 sin(e)),   l = sin(e) sin(f_1 + f_2).

    >>> float(part_pressure(np.pi, -0.5, 0.5, 0.0, 1.0, 1.0, 0.0, 0.6, 0.8)) / (0.24 * np.pi)
    1.0
    """
    e, root = t / 2, sine * cosine
    first = _level(sine_1 * cosine, cosine_1 * sine, start)
    second = _level(sine_2 * cosine, cosine_2 * sine, end)
    by_parts = e * root + end * second - start * first
    sine_e, cosine_e = np.sin(e), np.maximum(sine_1 * sine_2 + cosine_1 * cosine_2, NOTHING)
    right = start > 0  # the part lies to the right of x
    distance = np.maximum(np.maximum(start, -end), 0.0)
    near = where(right, sine_1 * cosine_1, sine_2 * cosine_2)
    level = where(right, second, first)
    length = sine_e * (sine_1 * cosine_2 + cosine_1 * sine_2)
    reach = np.maximum(distance * cosine_e + near * sine_e, NOTHING)
    y = np.minimum(root * sine_e / reach, _NEAR)
    bent = root / cosine_e * (near * (sine_e * sine_e) / reach - involute(e))
    afar = length * level + bent - distance * excess(y)
    far = (distance > 0) & (root * sine_e < _NEAR * reach) & (e < _WIDE)
    return where(far, afar, by_parts)


@shared
def _level(p: Array, q: Array, offset: Array) -> Array:
    """L = artanh(min(p, q)/max(p, q)), where offset is the difference of their squares."""
    least = np.minimum(p, q)
    return np.log1p(2 * (p * q + least * least) / np.maximum(np.abs(offset), NOTHING)) / 2
