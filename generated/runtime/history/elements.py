r"""Elements on the interface: the mesh, its influence matrix, pressure and full-stick shear on it.

E* = 1.  The shear traction is constant on each element, and all conditions hold for means over the
elements.  With w_i the width of element i and L twice the length of the mesh,

    A_ij = -(1/pi) int_i int_j ln(|x - s|/L) ds dx

is half the integral over element i of the displacement due to a unit traction on element j.  A is
symmetric and positive definite.  If each element i slips by 2 s_i while the shear load stays the
same, the shear tractions change by -K (w s), with

    K = A^-1 - (A^-1 w)(A^-1 w)^T/(w . A^-1 w).

While Q and sigma change under full stick, the shear traction changes at the rate

    dq/dt = [Q'/pi - (sigma'/4) (x - mid)]/sqrt((a + x)(c - x)),

whose integral over x has a closed form.  The rate is also integrated along the motion of the edges,
so that points that come into contact stick from then on, and the advance of an edge causes no slip.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..body import Body
from ..cycle import Own, pressure
from ..types import Array

CLOSEST = 0.02
"""Width of an element at a point of refinement relative to its width at a distance from it, in
which it is proportional to the distance: the distance, relative to the length of the mesh, that is
added to that from the point."""


class Elements(NamedTuple):
    """A mesh and its matrices.

    ends       ends of the elements
    widths     their widths w
    middles    their middles
    influence  the matrix A
    stiffness  the matrix K
    rise       shear traction that raises the load by 1 without slip, A^-1 w/(w . A^-1 w)
    """

    ends: Array
    widths: Array
    middles: Array
    influence: Array
    stiffness: Array
    rise: Array


def mesh(points: Array, fixed: Array, count: int) -> Array:
    """Ends of `count` elements from the first of the points to the last.

    The width of an element is proportional to its distance from the nearest point plus a constant.
    An element ends at each fixed point, unless another fixed point is in the same place.
    """
    points = np.unique(points)
    least = CLOSEST * (points[-1] - points[0])
    half = np.log1p(np.diff(points) / (2 * least))
    passed = np.concatenate([[0.0], np.cumsum(2 * half)])
    at = np.linspace(0, passed[-1], count + 1)
    k = np.searchsorted(passed[1:-1], at, side="right")
    since, left = at - passed[k], points[k]
    beside = since < half[k]
    distance = least * np.expm1(np.where(beside, since, 2 * half[k] - since))
    ends = np.where(beside, left + distance, points[k + 1] - distance)
    ends[0], ends[-1] = points[0], points[-1]
    held = np.zeros(count + 1, dtype=bool)
    held[[0, -1]] = True
    for x in fixed[(fixed > ends[0]) & (fixed < ends[-1])]:
        nearest = np.argmin(abs(ends - x))
        if not held[nearest]:
            ends[nearest], held[nearest] = x, True
    return ends


def elements_of(ends: Array) -> Elements:
    """The mesh with these ends, and its matrices."""
    widths, length = np.diff(ends), 2 * (ends[-1] - ends[0])
    v = abs(ends[:, None] - ends) / length
    second = v * v * (np.log(np.where(v > 0, v, 1.0)) / 2 - 0.75)  # second integral of ln|v|
    A = second[1:, :-1] + second[:-1, 1:] - second[:-1, :-1] - second[1:, 1:]
    A *= -(length**2) / math.pi
    inverse = np.linalg.inv(A)
    rise = inverse @ widths
    rise /= widths @ rise
    K = inverse - np.outer(rise, rise) * (widths @ inverse @ widths)
    return Elements(ends, widths, (ends[1:] + ends[:-1]) / 2, A, (K + K.T) / 2, rise)


# ---------------------------------------------------------------- values between the middles


def value_at(mesh: Elements, values: Array, x: Array) -> Array:
    """Values of the elements, along the last axis, at the points x.

    They vary linearly in each element, at the smaller of the slopes from its middle to those of its
    neighbours, so that a jump or a kink between two elements has no influence on the values next to
    it, and where nothing slips the slip is zero.
    """
    slopes = np.diff(values, axis=-1) / np.diff(mesh.middles)
    left = np.concatenate([slopes[..., :1], slopes], axis=-1)
    right = np.concatenate([slopes, slopes[..., -1:]], axis=-1)
    smaller = np.where(abs(left) < abs(right), left, right) * (left * right > 0)
    k = np.clip(np.searchsorted(mesh.ends, x) - 1, 0, mesh.middles.size - 1)
    return values[..., k] + smaller[..., k] * (x - mesh.middles[k])


# ---------------------------------------------------------------- pressure


def pressures(body: Body, own: Own, x: Array, a: Array, c: Array) -> Array:
    """Pressures at the points x, zero outside the contacts; the contacts are along the first axis.

    The pressure over sqrt((a + x)(c - x)) is expanded in Chebyshev polynomials.  The series saves
    many evaluations of pressures that are computed as integrals.  It does not converge, and the
    pressure itself is used, if the profile has a corner or a kink in the contact.
    """
    count = 20
    a, c = a[:, None], c[:, None]
    angle = math.pi * (np.arange(count) + 0.5) / count
    nodes = (a + c) * np.cos(angle / 2) ** 2 - a
    values = pressure(body, own, nodes, a, c, 1.0) / ((a + c) / 2 * np.sin(angle))
    terms = values @ np.cos(np.outer(angle, np.arange(count))) * (2 / count)
    terms[:, 0] /= 2
    smooth = np.max(abs(terms[:, -3:]), axis=1) < 1e-7 * np.max(abs(terms), axis=1)
    x = np.broadcast_to(x, (a.size, np.shape(x)[-1]))
    p, rest = np.zeros(x.shape), ~smooth
    root = np.sqrt(np.maximum((a + x) * (c - x), 0))[smooth]
    ratio = ((2 * x + a - c) / (a + c))[smooth]
    p[smooth] = root * chebyshev.chebval(ratio, terms[smooth].T[:, :, None], tensor=False)
    if np.any(rest):
        p[rest] = np.nan_to_num(pressure(body, own, x[rest], a[rest], c[rest], 1.0), posinf=np.inf)
    return p


def mean_pressures(body: Body, own: Own, ends: Array, a: Array, c: Array, load: Array) -> Array:
    """Mean pressures of the elements, one row per contact, scaled so that they carry the load.

    They follow from two nodes of Gauss's rule; in an element that ends at an edge of the contact,
    of the rule for the weight sqrt(s), as p = sqrt(s) (k + l s) there.
    """
    edge_nodes, edge_weights = (
        (0.28994919792569, 0.82116191318542),
        (0.27755599823067, 0.38911066843600),
    )
    low, high = np.maximum(ends[:-1], -a[:, None]), np.minimum(ends[1:], c[:, None])
    size = np.maximum(high - low, 0.0)
    left, right = low + a[:, None] <= 1e-9 * size, c[:, None] - high <= 1e-9 * size
    places, weights = [], []
    for k in range(2):
        s, inner = edge_nodes[k], 0.5 + (k - 0.5) / math.sqrt(3)
        places.append(
            np.where(left, low + s * size, np.where(right, high - s * size, low + inner * size))
        )
        weights.append(np.where(left | right, edge_weights[k] / math.sqrt(s), 0.5) * size)
    p = pressures(body, own, np.hstack(places), a, c) * np.hstack(weights)
    total = np.where(size > 0, p[:, : size.shape[1]] + p[:, size.shape[1] :], 0.0)
    carried = np.sum(total, axis=1)
    return total * (load / np.where(carried > 0, carried, 1.0))[:, None] / np.diff(ends)


# ---------------------------------------------------------------- shear under full stick


def _force(x: Array, a: Array, c: Array, dQ: Array, dsigma: Array) -> Array:
    """Integral of the full-stick change in shear from the middle of the contact to x."""
    half = (a + c) / 2
    offset = np.clip(x - (c - a) / 2, -half, half)
    with np.errstate(all="ignore"):
        angle = np.arcsin(np.clip(offset / half, -1, 1))
    return dQ / math.pi * angle + dsigma / 4 * np.sqrt(np.maximum(half**2 - offset**2, 0))


def full_stick(ends: Array, a: Array, c: Array, Q: Array, sigma: Array) -> Array:
    """Changes in the mean shear of the elements under full stick, a row for each but the first row.

    a, c, Q, sigma: one value per row; they vary linearly from one row to the next.

    The force up to x is averaged over the step.  Near the instant at which an edge passes x, it
    varies like the square root of the time difference.
    """
    a, c, Q, sigma = (v[:, None] for v in (a, c, Q, sigma))
    inside = (-a < ends) & (ends < c)
    enters, leaves = ~inside[:-1] & inside[1:], inside[:-1] & ~inside[1:]
    da, dc, dQ, dsigma = (np.diff(v, axis=0) for v in (a, c, Q, sigma))
    a, c = a[:-1], c[:-1]
    if not np.any(enters | leaves | (da != 0) | (dc != 0)):
        return np.diff(_force(ends, a, c, dQ, dsigma)) / np.diff(ends)
    on_left = np.where(enters, ends <= -a, ends <= -(a + da))
    with np.errstate(all="ignore"):
        passed = np.where(on_left, (-a - ends) / da, (ends - c) / dc)
    passed = np.where(enters | leaves, passed, 0.0)
    # the part of the step in which x is outside the contact
    outside = np.where(enters, passed, np.where(leaves, 1 - passed, 0.0))
    late = np.where(leaves, 1.0, 0.0)
    mean = outside * _force(ends, a + late * da, c + late * dc, dQ, dsigma)
    nodes, weights = np.polynomial.legendre.leggauss(5)
    for u, weight in zip((1 + nodes) / 2, weights / 2, strict=True):
        t = np.where(leaves, passed * (1 - u * u), u)
        t = np.where(enters, passed + (1 - passed) * u * u, t)
        share = np.where(enters | leaves, 2 * u * (1 - outside), 1.0)
        mean += weight * share * _force(ends, a + t * da, c + t * dc, dQ, dsigma)
    return np.diff(mean) / np.diff(ends)
