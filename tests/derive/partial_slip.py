"""Partial slip in 30 digits from p(x) alone: the two conditions, and their solution.

Written by hand beside the program's: the conditions in the form of the singular integral equation,

    int_slip r/w dxi = -pi dsigma/4,      int_slip r xi/w dxi = dQ + pi dsigma (m - n)/8,

w = sqrt((xi + m)(xi - n)), negative on the left; not in the combined form that the program solves.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import mpmath
from mpmath import mpf

Pressure = Callable[[mpf], mpf]


@dataclass(frozen=True)
class Cycle:
    """Two contacts [-a, c] with their pressures, and what changes between them.

    kappa   sense of slip on the left and on the right
    kinks   where the pressures may not be smooth
    """

    pressures: tuple[Pressure, Pressure]
    a: tuple[mpf, mpf]
    c: tuple[mpf, mpf]
    f: mpf
    dQ: mpf
    dsigma: mpf
    kappa: tuple[int, int]
    kinks: tuple[float, ...] = ()

    def residuals(self, m: mpf, n: mpf) -> tuple[mpf, mpf]:
        """What is left over of both conditions."""
        strain, force = -self._over_slip(m, n, 0), -self._over_slip(m, n, 1)
        strain = -strain + mpmath.pi * self.dsigma / 4
        force = -force - self.dQ - mpmath.pi * self.dsigma * (m - n) / 8
        return strain, force

    def _over_slip(self, m: mpf, n: mpf, power: int) -> mpf:
        """int r xi**power/w dxi over both slip zones, both contacts."""
        total = mpf(0)
        for p, a, c in zip(self.pressures, self.a, self.c, strict=True):
            for start, edge, kappa, sign in (
                (-m, -a, self.kappa[0], -1),
                (n, c, self.kappa[1], 1),
            ):
                away = sign * (edge - start)  # length of the slip zone in this contact
                cuts = [sign * (mpf(k) - start) for k in self.kinks]
                total += (
                    self.f
                    * kappa
                    * integral(
                        lambda y, p=p, start=start, sign=sign: (
                            p(start + sign * y)
                            * (start + sign * y) ** power
                            * sign
                            / mpmath.sqrt(m + n + y)
                        ),
                        away,
                        cuts,
                    )
                )
        return total

    def solution(self, m: float, n: float) -> tuple[mpf, mpf]:
        """m and n from a guess, by a secant method of two unknowns."""
        found = mpmath.findroot(self.residuals, (mpf(m), mpf(n)), tol=mpf(10) ** -20)
        return found[0], found[1]


def integral(integrand: Callable[[mpf], mpf], length: mpf, cuts: Sequence[mpf] = ()) -> mpf:
    """int_0^length integrand(y)/sqrt(y) dy, by y = length sin(t)**2 between the cuts."""
    inside = sorted(cut for cut in cuts if 0 < cut < length)
    angles = [mpmath.asin(mpmath.sqrt(cut / length)) for cut in (*inside, length)]

    def along(t: mpf) -> mpf:
        return 2 * mpmath.sqrt(length) * mpmath.cos(t) * integrand(length * mpmath.sin(t) ** 2)

    return sum(
        (mpmath.quad(along, part) for part in pairwise([mpf(0), *angles])),
        mpf(0),
    )
