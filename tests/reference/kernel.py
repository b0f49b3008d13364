"""Displacements due to tractions that are linear between nodes.

    u(x) = -(1/pi) int t(xi) ln|x - xi| dxi

is E*/2 times the normal or tangential displacement of the surface of one half-plane relative to
that of a similar one, due to the traction t on it, up to a constant.  t = sum_j t_j hat_j(x).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tests.reference.mesh import Floats

FAR = 8.0
"""Distance in element lengths beyond which Gauss quadrature is exact to rounding."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True)
class Surface:
    """The nodes, and the displacements, force and moment due to unit tractions at them."""

    x: Floats

    @cached_property
    def influence(self) -> Floats:
        """L[i, j] = u(x_i) due to the hat function of node j, which consists of two ramps."""
        length = np.diff(self.x)
        away = (self.x[:, None] - self.x)[:, :-1] / length
        scale = np.log(length) / 2  # int_0^1 (1 - u) ln(length) du
        L = np.zeros((len(self.x), len(self.x)))
        L[:, :-1] += length * (scale + ramp(away))
        L[:, 1:] += length * (scale + ramp(1 - away))
        return -L / np.pi

    @cached_property
    def force(self) -> Floats:
        """int hat_j dx."""
        half = np.diff(self.x) / 2
        return np.append(half, 0) + np.append(0, half)

    @cached_property
    def moment(self) -> Floats:
        """int hat_j x dx."""
        left, right, sixth = self.x[:-1], self.x[1:], np.diff(self.x) / 6
        return np.append(sixth * (2 * left + right), 0) + np.append(0, sixth * (left + 2 * right))


def ramp(z: Floats) -> Floats:
    """int_0^1 (1 - u) ln|z - u| du.

    >>> ramp(np.array([0.0, 1.0]))
    array([-0.75, -0.25])
    """
    near = np.abs(z) < FAR
    return np.where(near, _closed(np.where(near, z, 0)), _quadrature(np.where(near, FAR, z)))


def _closed(z: Floats) -> Floats:
    """The integral in closed form, with v = u - z and e = 1 - z; inaccurate for large |z|."""
    e = 1 - z
    return e * (_xlogx(e) / 2 + _xlogx(z) - 3 * e / 4 - z) + z * (_xlogx(z) / 2 - z / 4)


def _xlogx(v: Floats) -> Floats:
    """v ln|v|."""
    return v * np.log(np.abs(np.where(v == 0, 1, v)))


def _quadrature(z: Floats) -> Floats:
    """The integral by Gauss's rule with eight nodes."""
    total = np.zeros_like(z)
    for node, weight in zip((1 + NODES) / 2, WEIGHTS / 2, strict=True):
        total += weight * (1 - node) * np.log(np.abs(z - node))
    return total
