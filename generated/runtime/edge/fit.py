"""Coefficients of an edge from nodal pressures, from the shear of a run without slip, from loads.

Next to an edge p**2 = K_N**2 s + 2 K_N L_N s**2 + ... is a polynomial, whose root is the edge.
Once the edge is known, full-stick dq sqrt(s) = K_T + L_T s + ... is another polynomial.  It is
divided by its value in a half-plane, where it is linear apart from the root of the distance from
the other edge.  average.py fits both.

A mesh does not end where the contact does.  The edge lies between the first node in contact and the
one before.  A bonded mesh has its edge within half an element of the true one, which adds
K_T shift/(2 s) to the polynomial.  Each is one more unknown, known in advance to be zero with a
standard deviation of EDGE_SPREAD elements.  The first node is left out, and the error of the next
ones is that of the mesh times (element/s)**2.5.
"""

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from ..arrays import number, real
from ..types import Edges, Values
from .average import averaged

EDGE_SPREAD = 0.35
"""Standard deviation of the edge of a mesh from that of the contact, in elements."""

PRESSURE_MESH_ERROR, SHEAR_MESH_ERROR = 0.06, 0.5
"""Relative error of a traction one element from the edge, on a mesh of equal elements.  That of the
pressure was measured as 6 % at 1, 0.6 % at 2 and 0.1 % at 5 elements; that of bonded shear as 16 %
at 1.5, 2 % at 3 and 0.7 % at 4 elements."""


class PressureFit(NamedTuple):
    """An edge from nodal pressures.  Errors are one standard deviation.

    Attributes
    ----------
    edge : float
        Position of the edge [m].
    K_N, L_N : float
        Coefficients of sqrt(s) and s**(3/2), s the distance inward [Pa/sqrt(m), Pa/m**(3/2)].
    edge_error, K_N_error, L_N_error : float
        Errors of these.
    nodes : int
        Number of nodes that the best fit uses.
    stretch : float
        Largest distance of these nodes from the edge [m].
    degree : int
        Degree of p**2 in this fit.
    misfit : float
        Misfit of these nodes, over the scatter; about 1 if the fit is good.
    why : str
        Why this fit is the best.
    warning : str
        Reasons to doubt the result; "" if there are none.
    """

    edge: float = math.nan
    K_N: float = math.nan
    L_N: float = math.nan
    edge_error: float = math.nan
    K_N_error: float = math.nan
    L_N_error: float = math.nan
    nodes: int = 0
    stretch: float = math.nan
    degree: int = 0
    misfit: float = math.nan
    why: str = ""
    warning: str = ""


class ShearFit(NamedTuple):
    """Full stick next to an edge.  Errors are one standard deviation.

    Attributes
    ----------
    K_T, L_T : float
        Coefficients of 1/sqrt(s) and sqrt(s) [Pa sqrt(m), Pa/sqrt(m)], signed as dq.
    K_T_error, L_T_error : float
        Errors of these.
    nodes, stretch, degree, misfit, why, warning
        As in PressureFit, of dq sqrt(s).
    """

    K_T: float = math.nan
    L_T: float = math.nan
    K_T_error: float = math.nan
    L_T_error: float = math.nan
    nodes: int = 0
    stretch: float = math.nan
    degree: int = 0
    misfit: float = math.nan
    why: str = ""
    warning: str = ""


def fit_pressure(x: Values, p: Values) -> PressureFit:
    """The edge nearer to the first node, with K_N and L_N, from nodal pressures.

    Parameters
    ----------
    x : array_like
        Positions of the nodes along the interface, increasing or decreasing [m].  Nodes outside the
        contact may be omitted.  The distance to the next node is then assumed to be that between
        the first two nodes of the contact.
    p : array_like
        Contact pressure at the nodes, zero outside the contact [Pa].

    Returns
    -------
    PressureFit
        NaN, with a warning that gives the reason, if no range of nodes follows the square-root law.

    Raises
    ------
    TypeError
        If an argument is not an array of real numbers.
    ValueError
        If the arguments are not a table of one contact.

    Examples
    --------
    >>> x = np.linspace(-1.03, 1.07, 64)
    >>> found = fit_pressure(x, np.sqrt(np.maximum(1 - x**2, 0.0)))
    >>> f"{found.edge:.4f}, K_N = {found.K_N:.3f}"  # -1 and sqrt(2)
    '-1.0000, K_N = 1.414'
    """
    places, values = _table(x, p, "p")
    first, last = map(int, np.flatnonzero(values)[[0, -1]]) if np.any(values) else (0, 0)
    contact, inner = slice(first, last + 1), slice(first + 1, last)
    for at in first + np.flatnonzero(values[contact] <= 0):
        raise ValueError(
            "p must be positive at the nodes of one contact and 0 at all others; it is "
            f"{values[at]:.6g} at x = {places[at]:.6g}: give compression as positive, and one "
            "contact at a time"
        )
    if last - first < 9:
        few = f"{last - first + 1} nodes in contact are too few: use a finer mesh"
        return PressureFit(nodes=last - first + 1, warning=few)
    inward = np.sign(places[-1] - places[0])
    element = abs(places[first] - places[first - 1 if first else first + 1])
    middle = places[first] - inward * element / 2
    # the outermost nodes belong to elements that are only partly in contact
    s, y = inward * (places[inner] - middle), values[inner]
    found = averaged(
        PressureFit,
        places[contact],
        s,
        y**2,
        rate=2 * y,
        mesh=PRESSURE_MESH_ERROR * y * (element / s) ** 2.5,
        half=max(int(np.argmax(y)) + 1, len(y) // 2),
        powers=np.arange(6),
        spread=EDGE_SPREAD * element * y[0] ** 2 / s[0],
        read=lambda b: _at_root(b, s[-1], 1.5 * element),
    )
    edge = float(middle + inward * found.edge)
    return found._replace(edge=edge, stretch=found.stretch - found.edge)


def fit_stuck_shear(x: Values, dq: Values, edge: float, edge_error: float = 0.0) -> ShearFit:
    """K_T and L_T of an edge, from the change in shear traction in a run without slip.

    Nodes outside the edge, and the node of the element in which the contact ends, are left out.
    The other edge is taken to lie behind the last node with a traction.

    Parameters
    ----------
    x : array_like
        As in fit_pressure.
    dq : array_like
        Change in the shear traction at the nodes, in a bonded or fully stuck contact [Pa].
    edge : float
        Position of the edge nearer to the first node, as returned by fit_pressure [m].
    edge_error : float, optional
        Standard deviation of this position [m].

    Returns
    -------
    ShearFit
        NaN, with a warning that gives the reason, if no range of nodes follows the square-root law.

    Raises
    ------
    TypeError, ValueError
        As in fit_pressure; also ValueError if the edge does not lie next to the table's first node.

    Examples
    --------
    >>> x = np.linspace(-1, 1, 64)[1:-1]
    >>> found = fit_stuck_shear(x, 1 / np.sqrt(1 - x**2), -1.0)
    >>> f"K_T = {found.K_T:.3f}"  # 1/sqrt(2) = 0.7071
    'K_T = 0.707'
    """
    places, values = _table(x, dq, "dq")
    edge, edge_error = number(edge, "edge"), number(edge_error, "edge_error", "non-negative finite")
    s = (places - edge) * np.sign(places[-1] - places[0])
    steps = np.diff(s)[s[1:] > 0]
    if len(steps) == 0 or s[0] > 3 * steps[0]:
        raise ValueError(
            f"the edge at {edge:.6g} does not lie next to the first of the nodes, {places[0]:.6g} "
            f"to {places[-1]:.6g}: give the nodes from this edge inward"
        )
    element = steps[0]
    inside = (s >= element / 2) & (s <= np.max(s[values != 0], initial=0.0))
    s, values = s[inside][1:], values[inside][1:]
    if len(s) < 8:
        few = f"{np.sum(inside)} nodes with a shear traction are too few: use a finer mesh"
        return ShearFit(nodes=int(np.sum(inside)), warning=few)
    width = s[-1] + element  # the other edge lies about there, if the table reaches it
    y = values * np.sqrt(s * (1 - s / width))
    level = np.median(np.abs(y[: len(s) // 2]))
    found = averaged(
        ShearFit,
        places[inside],
        s,
        y,
        rate=np.ones(len(s)),
        mesh=SHEAR_MESH_ERROR * level * (element / s) ** 2.5,
        half=len(s) // 2,
        powers=np.arange(-1, 4),
        spread=level * math.hypot(EDGE_SPREAD * element, edge_error) / (2 * s[-1]),
        read=lambda b: np.stack([b[1], b[2] / s[-1]]),
    )
    # a mesh bonded over another width carries the same load with another K_T
    width_error = EDGE_SPREAD * element / width / math.sqrt(2) * abs(found.K_T)
    return found._replace(
        L_T=float(found.L_T + found.K_T / (2 * width)),
        K_T_error=math.hypot(found.K_T_error, width_error),
    )


def K_N_from_loads(P: Values, M: Values, a: Values, c: Values) -> Edges:
    """K_N at both edges of any body's contact, from reaction forces at two neighbouring loads.

        K_N dedge = 2 (dP +/- 4 (dM + mid dP)/h)/(pi sqrt(h)), the upper sign at the left edge

    Each argument holds the two loads along its last axis; the other axes broadcast.

    Parameters
    ----------
    P : array_like
        Normal load per unit depth [N/m].
    M : array_like
        Moment per unit depth, M = -int p x dx [N].
    a, c : array_like
        The contact [-a, c] [m].

    Returns
    -------
    Edges
        left [Pa/sqrt(m)], right [Pa/sqrt(m)], for the contact midway between the two. NaN at an
        edge that does not move.

    Raises
    ------
    TypeError
        If an argument is not an array of real numbers.
    ValueError
        Unless each argument holds two loads.

    Examples
    --------
    >>> R, h = 2.0, np.array([1.99, 2.01])  # a cylinder, E* = 1: P = pi h**2/(16 R)
    >>> found = K_N_from_loads(np.pi * h**2 / (16 * R), 0.0 * h, h / 2, h / 2)
    >>> f"{found.left:.4f}"  # sqrt(h)/(2 R)
    '0.3536'
    """
    given = [np.asarray(real(v, name)) for v, name in ((P, "P"), (M, "M"), (a, "a"), (c, "c"))]
    if any(v.ndim == 0 or v.shape[-1] != 2 for v in given):
        raise ValueError(
            "P, M, a and c must each hold two values along their last axis, one for each load; "
            f"their shapes are {', '.join(str(v.shape) for v in given)}"
        )
    (dP, dM, da, dc) = (v[..., 1] - v[..., 0] for v in given)
    at_a, at_c = (v.mean(-1) for v in given[2:])
    with np.errstate(all="ignore"):
        h, mid = at_a + at_c, (at_c - at_a) / 2
        scale, turn = 2 / (np.pi * np.sqrt(h)), 4 * (dM + mid * dP) / h
        K_N = scale * (dP + turn) / da, scale * (dP - turn) / dc
    return Edges(*(np.where((K > 0) & (np.inf > K), K, np.nan)[()] for K in K_N))


def _table(x: Any, values: Any, name: str) -> tuple[Any, Any]:
    """Both columns as numbers, with x increasing or decreasing.

    Raises ValueError if they are not a table.
    """
    x, values = np.asarray(real(x, "x")), np.asarray(real(values, name))
    if x.ndim != 1 or values.shape != x.shape or len(x) < 2:
        raise ValueError(
            f"x and {name} must be rows of equal length and must hold at least two nodes; their "
            f"shapes are {x.shape} and {values.shape}"
        )
    for column, label in ((x, "x"), (values, name)):
        for at in np.flatnonzero(~np.isfinite(column)):
            raise ValueError(f"{label} is {column[at]} at node {at + 1}: give finite numbers only")
    steps = np.diff(x)
    for at in np.flatnonzero(np.sign(steps) * np.sign(steps[0]) <= 0):
        raise ValueError(
            f"x must rise or fall from each node to the next; it is {x[at]:.6g} at node {at + 1} "
            f"and {x[at + 1]:.6g} at the next: sort the nodes along x, and give each node once"
        )
    return x, values


def _at_root(b: Any, length: float, limit: float) -> Any:
    """Edge, K_N and L_N of p**2 = sum b (s/length)**j, by Newton's method from s = 0.

    NaN if the root lies beyond the limit, or the pressure falls there.
    """
    square, slope, curvature = (
        partial(polynomial.polyval, c=polynomial.polyder(b, k), tensor=False) for k in range(3)
    )
    u: Any = 0.0
    for _ in range(20):
        step = square(u) / slope(u)
        u = u - step
    K = np.sqrt(slope(u) / length)
    L = curvature(u) / (4 * K * length**2)
    found = (np.abs(u) * length <= limit) & (np.abs(step) < 1e-9)
    return np.where(found, np.stack([u * length, K, L]), np.nan)
