"""The composite modulus of two bodies in plane strain, and whether shear and pressure decouple."""

import warnings
from typing import Any

import numpy as np

from ..arrays import evaluated
from ..types import Array, Values


class EdgeWarning(UserWarning):
    """Warns of a limitation of a result that can still be used."""


def E_star(E: Values, nu: Values, E_2: Values | None = None, nu_2: Values | None = None) -> Array:
    """Composite modulus of two bodies in plane strain.

        1/E* = (1 - nu**2)/E + (1 - nu_2**2)/E_2

    Parameters
    ----------
    E, nu : array_like
        Young's modulus [Pa] and Poisson's ratio [-] of one body.
    E_2, nu_2 : array_like, optional
        Those of the other body; equal to the first if omitted.  Give both or neither.

    Returns
    -------
    ndarray
        E* [Pa], of the shape to which the arguments broadcast. NaN unless E > 0 and
        -1 < nu <= 1/2. Warns (EdgeWarning) if Dundurs' beta is not zero, because the formulas of
        this package hold for similar bodies, in which shear does not change the pressure.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If the shapes of the arguments do not broadcast, or only one of E_2 and nu_2 is given.

    Examples
    --------
    >>> f"{E_star(210e9, 0.3):.4g}"
    '1.154e+11'
    """
    if (E_2 is None) != (nu_2 is None):
        raise ValueError(
            "E_2 and nu_2 must be given together: give both, or neither for similar bodies"
        )
    if E_2 is None or nu_2 is None:
        E_2, nu_2 = E, nu
    beta = np.abs(dundurs(E, nu, E_2, nu_2))
    if np.any(beta > 1e-9):  # more than rounding
        warnings.warn(
            f"Dundurs' beta is {np.nanmax(beta):.3g}, not 0: pressure and shear affect each other, "
            "which the formulas for similar bodies neglect; beta/f measures the effect",
            EdgeWarning,
            stacklevel=2,
        )
    return evaluated(_modulus, {"E": E, "nu": nu, "E_2": E_2, "nu_2": nu_2}, {})


def dundurs(E: Values, nu: Values, E_2: Values, nu_2: Values) -> Array:
    """Dundurs' second parameter beta in plane strain; 0 if pressure and shear decouple.

        beta = (E* /2) ((1 - 2 nu)(1 + nu)/E - (1 - 2 nu_2)(1 + nu_2)/E_2)

    Parameters
    ----------
    E, nu : array_like
        Young's modulus [Pa] and Poisson's ratio [-] of one body.
    E_2, nu_2 : array_like
        Those of the other body.

    Returns
    -------
    ndarray
        Beta [-], between -1/2 and 1/2, of the shape to which the arguments broadcast; its sign
        changes if the bodies are exchanged. NaN where E_star is NaN.

    Raises
    ------
    TypeError, ValueError
        As in E_star.

    Examples
    --------
    >>> f"{dundurs(70e9, 0.33, 210e9, 0.3):.3f}"  # aluminium on steel
    '0.117'
    """

    def beta(E: Any, nu: Any, E_2: Any, nu_2: Any) -> Any:
        difference = (1 - 2 * nu) * (1 + nu) / E - (1 - 2 * nu_2) * (1 + nu_2) / E_2
        return _modulus(E, nu, E_2, nu_2) / 2 * difference

    return evaluated(beta, {"E": E, "nu": nu, "E_2": E_2, "nu_2": nu_2}, {})


def _modulus(E: Any, nu: Any, E_2: Any, nu_2: Any) -> Any:
    """E*; NaN where a number is not that of an elastic body."""
    exist = (E > 0) & np.isfinite(E) & (E_2 > 0) & np.isfinite(E_2)
    exist &= (nu > -1) & (nu <= 0.5) & (nu_2 > -1) & (nu_2 <= 0.5)
    return np.where(exist, 1 / ((1 - nu**2) / E + (1 - nu_2**2) / E_2), np.nan)
