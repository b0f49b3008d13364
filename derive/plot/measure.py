"""The units of axes: a unit with a prefix, or a quantity of the problem for ratios."""

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = Any


@dataclass(frozen=True)
class Measure:
    """The unit or quantity by which values are divided before they are drawn.

    Parameters
    ----------
    size : float
        Its value in SI units, such as 1e-3, or the half-width of a contact.
    name : str
        Its name on the axis: a unit, or a symbol in LaTeX.
    ratio : bool, optional
        Whether it is a quantity of the problem, so that ratios are drawn.

    Raises
    ------
    ValueError
        If the size is not finite and positive.

    Examples
    --------
    >>> mm = Measure(1e-3, "mm")
    >>> float(mm(0.25)), mm.label("x")
    (250.0, '$x$  [mm]')
    >>> Measure(0.5, "a", ratio=True).label("x")
    '$x/a$'
    """

    size: float
    name: str
    ratio: bool = False

    def __post_init__(self) -> None:
        if not (np.isfinite(self.size) and self.size > 0):
            raise ValueError(
                f"{self.name!r} has the size {self.size}, but values can only be divided by a "
                "finite positive number; give a length or load of the problem"
            )

    def __call__(self, values: Array) -> Array:
        """The values as drawn; infinite values become NaN and are left out."""
        drawn = np.asarray(values, dtype=float) / self.size
        return np.where(np.isfinite(drawn), drawn, np.nan)

    def label(self, symbol: str) -> str:
        """The axis label."""
        return f"${symbol}/{self.name}$" if self.ratio else f"${symbol}$  [{self.name}]"


_PREFIXES = {
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "Pa": ((1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "N/m": ((1e6, "MN/m"), (1e3, "kN/m"), (1.0, "N/m")),
    "N": ((1.0, "N"),),
    "rad": ((1.0, "rad"), (1e-3, "mrad")),
    "J/m²": ((1e3, "kJ/m²"), (1.0, "J/m²")),
    "-": ((1.0, "-"),),
}
_LEAST = 0.1
"""The largest value in the chosen unit is at least this number."""


def unit(values: Array, of: str) -> Measure:
    """The suitable unit for the values, with a prefix.

    Parameters
    ----------
    values : array_like
        The values that will be drawn, in SI units.
    of : str
        Their SI unit: m, Pa, N/m, N, rad, J/m², or - for none.

    Returns
    -------
    Measure
        The unit.

    Raises
    ------
    ValueError
        If the unit is not one of these.

    Examples
    --------
    >>> unit([2e-4, 7e-4], "m").name, unit(890e6, "Pa").name
    ('mm', 'MPa')
    """
    known = _PREFIXES.get(of)
    if known is None:
        raise ValueError(f"the unit {of!r} is not known; give one of {', '.join(_PREFIXES)}")
    values = np.abs(np.asarray(values, dtype=float))
    greatest = np.max(values, initial=0.0, where=np.isfinite(values))
    fitting = (Measure(size, name) for size, name in known if greatest >= _LEAST * size)
    return next(fitting, Measure(1.0, of))
