"""The composite modulus of two bodies in plane strain, and whether shear and pressure decouple."""

import warnings
from typing import Any

import numpy as np

from ..arrays import evaluated, real
from ..types import Array

SEPARATE = 1e-9
"""Bodies count as similar up to this value of Dundurs' beta."""


class EdgeWarning(UserWarning):
    """Warns of a limitation of a result that can still be used."""


def E_star(E: Array, nu: Array, E_2: Array = None, nu_2: Array = None) -> Array:
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
        E* [Pa]. NaN unless E > 0 and -1 < nu <= 1/2. Warns (EdgeWarning) if Dundurs' beta is not
        zero, because the formulas of this package hold for similar bodies, in which shear does
        not change the pressure.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If the shapes of the arguments do not broadcast, or only one of E_2 and nu_2 is given.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> f"{E_star(210e9, 0.3):.4g}"
    '1.154e+11'
    """
    if (E_2 is None) != (nu_2 is None):
        raise ValueError(
            "E_2 and nu_2 must be given together: give both, or neither for similar bodies"
        )
    given = {"E": real(E, "E"), "nu": real(nu, "nu")}
    if E_2 is None:
        return evaluated(lambda E, nu: 1 / (2 * _compliance(E, nu)), given, {})
    given |= {"E_2": real(E_2, "E_2"), "nu_2": real(nu_2, "nu_2")}
    beta = np.abs(dundurs(E, nu, E_2, nu_2))
    if np.any(beta > SEPARATE):
        warnings.warn(
            f"Dundurs' beta is {np.nanmax(beta):.3g}, not 0: pressure and shear affect each other, "
            "which the formulas for similar bodies neglect; beta/f measures the effect",
            EdgeWarning,
            stacklevel=2,
        )
    return evaluated(
        lambda E, nu, E_2, nu_2: 1 / (_compliance(E, nu) + _compliance(E_2, nu_2)),
        given,
        {},
    )


def dundurs(E: Array, nu: Array, E_2: Array, nu_2: Array) -> Array:
    """Dundurs' second parameter beta in plane strain; 0 if pressure and shear decouple.

        beta = (E* /2) ((1 - 2 nu)(1 + nu)/E - (1 - 2 nu_2)(1 + nu_2)/E_2)

    Parameters
    ----------
    E : array_like
        Young's modulus of one body [Pa].
    nu : array_like
        Its Poisson's ratio [-].
    E_2 : array_like
        Young's modulus of the other body [Pa].
    nu_2 : array_like
        Its Poisson's ratio [-].

    Returns
    -------
    ndarray
        Beta [-], between -1/2 and 1/2; its sign changes if the bodies are exchanged. NaN where
        E_star is NaN.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If the shapes of the arguments do not broadcast.

    Notes
    -----
    Arguments broadcast; results are float64 of the broadcast shape.

    Examples
    --------
    >>> f"{dundurs(70e9, 0.33, 210e9, 0.3):.3f}"  # aluminium on steel
    '0.117'
    """
    given = {"E": real(E, "E"), "nu": real(nu, "nu")}
    given |= {"E_2": real(E_2, "E_2"), "nu_2": real(nu_2, "nu_2")}

    def beta(E: Any, nu: Any, E_2: Any, nu_2: Any) -> Any:
        one, two = _compliance(E, nu), _compliance(E_2, nu_2)
        difference = (1 - 2 * nu) * (1 + nu) / E - (1 - 2 * nu_2) * (1 + nu_2) / E_2
        return difference / (2 * (one + two))

    return evaluated(beta, given, {})


def _compliance(E: Any, nu: Any) -> Any:
    """(1 - nu**2)/E; NaN where E or nu is not that of an elastic body."""
    exists = (E > 0) & np.isfinite(E) & (nu > -1) & (nu <= 0.5)
    return np.where(exists, (1 - nu**2) / E, np.nan)
