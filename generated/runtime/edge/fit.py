r"""Coefficients of an edge from nodal pressures, and from the shear of a run without slip.

Next to an edge p**2 = K_N**2 s + 2 K_N L_N s**2 + ... is a polynomial, whose root is the edge.
Once the edge is known, full-stick dq sqrt(s) = K_T + L_T s + ... is another polynomial.

The first node under pressure belongs to the element in which the contact ends, and is left out.
The fact that the edge lies between this node and the previous one is used as an additional data
point.  Polynomials of degree 1 to 3 are fitted to all stretches that begin after the first node.
The scatter of the nodes is estimated from cubics fitted to short stretches all over the contact, at
most two thirds of which are assumed to meet kinks.  The error of the mesh next to the edge is added
to the scatter.  The stretch and the degree are those that minimise

    misfit**2 + 2 (coefficients + nodes left out)

(Akaike's criterion, in which a node left out counts as one more parameter).  The result comes from
a fit of one degree higher over the same nodes.  Its error combines the scatter with the change due
to this degree, as an estimate of the next term.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from ..arrays import real
from ..types import Array, Edges

DEGREES = (1, 2, 3)
"""Degrees of p**2."""

STUCK = (0, 1, 2)
"""Degrees of dq sqrt(s)."""

SPAN, LOCAL = 6, 3
"""Number of nodes in a short stretch from which the scatter is estimated, and the degree fitted to
it."""

SHARE, EXPECTED = 1 / 3, 0.4055
"""Least fraction of the short stretches that meet no kink, and the quantile at this fraction of the
mean of two squared standard normal numbers."""

BRACKET = 0.35
"""Standard deviation of the edge from the middle of the element it lies in, over the element's
size."""

MESH, DECAY = 0.05, 2.5
"""Relative error of a mesh next to an edge: MESH (element/s)**DECAY.  Measured on the equal
elements of tests/reference, whose error is 6 % at s = 1, 0.6 % at 2 and 0.1 % at 5 elements."""

AWAY = 1.5
"""Largest distance, in elements, of an edge from that middle."""

LEAST = 12
"""Smallest number of nodes between an edge and the middle of the contact, or the point of largest
pressure, that leaves several ranges of nodes to choose from.  With fewer nodes, errors that are
small by chance are misleading."""

POOR = 0.075
"""Relative error of K above which a warning is given: half of all draws of a normal distribution
lie within two thirds of it, 5 %."""

WORST = 3.0
"""Squared misfit over squared scatter above which no range of nodes follows the square-root law."""


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
        Number of nodes used.
    stretch : float
        Largest distance of these nodes from the edge [m].
    degree : int
        Degree of p**2.
    misfit : float
        Misfit of these nodes, over the scatter; about 1 if the fit is good.
    why : str
        Why this stretch was chosen.
    warning : str
        Reasons to doubt the result; "" if there are none.
    """

    edge: float
    K_N: float
    L_N: float
    edge_error: float
    K_N_error: float
    L_N_error: float
    nodes: int
    stretch: float
    degree: int
    misfit: float
    why: str
    warning: str


class ShearFit(NamedTuple):
    """Full stick next to an edge.  Errors are one standard deviation.

    Attributes
    ----------
    K_T, L_T : float
        Coefficients of 1/sqrt(s) and sqrt(s) [Pa sqrt(m), Pa/sqrt(m)], signed as dq.
    K_T_error, L_T_error : float
        Errors of these.
    nodes, stretch, degree, misfit, why, warning
        As in PressureFit.
    """

    K_T: float
    L_T: float
    K_T_error: float
    L_T_error: float
    nodes: int
    stretch: float
    degree: int
    misfit: float
    why: str
    warning: str


class _Fit(NamedTuple):
    """A polynomial fitted to a stretch: derived values, their covariance, squared misfit."""

    degree: int
    used: int
    values: Any
    covariance: Any
    misfit: float


class _Chosen(NamedTuple):
    values: Any
    errors: Any
    degree: int
    used: int
    misfit: float


def fit_pressure(x: Array, p: Array) -> PressureFit:
    """The edge nearer to the first node, with K_N and L_N, from nodal pressures.

    Parameters
    ----------
    x : array_like
        Positions of the nodes along the interface, increasing or decreasing [m].
    p : array_like
        Contact pressure at the nodes, zero outside the contact [Pa].

    Returns
    -------
    PressureFit
        NaN, with a warning that gives the reason, if no range of nodes follows the square-root law.

    Raises
    ------
    ValueError
        If the arguments are not a table of one contact.

    Notes
    -----
    Nodes outside the contact may be omitted.  The distance to the next node is then assumed to be
    that between the first two nodes of the contact.

    Examples
    --------
    >>> x = np.linspace(-1.03, 1.07, 64)
    >>> found = fit_pressure(x, np.sqrt(np.maximum(1 - x**2, 0.0)))
    >>> f"{found.edge:.4f}, K_N = {found.K_N:.3f}"  # -1 and sqrt(2)
    '-1.0000, K_N = 1.414'
    """
    x, p = _table(x, p, "p")
    if np.any(p < 0):
        raise ValueError(
            f"pressure must not be negative; it is negative at {np.sum(p < 0)} of {len(p)} nodes: "
            "give compression as positive, and 0 outside the contact"
        )
    inside = np.flatnonzero(p > 0)
    if len(inside) == 0:
        raise ValueError(
            "pressure is zero at all nodes, so there is no contact: give a table with positive "
            "pressures"
        )
    first, last = inside[0], inside[-1]
    if len(inside) < last - first + 1:
        gap = x[first : last + 1][p[first : last + 1] == 0][0]
        raise ValueError(
            f"pressure is zero at x = {gap:.6g} between nodes in contact: give the nodes of one "
            "contact at a time"
        )
    sense = 1.0 if x[-1] > x[0] else -1.0
    z = sense * (x - x[first])
    z, y = z[first : last + 1], p[first : last + 1]
    if len(z) < SPAN + 2:
        return _no_pressure(f"{len(z)} nodes in contact are too few: use a finer mesh", len(z))
    element = sense * float(x[first] - x[first - 1]) if first else float(z[1] - z[0])
    z, y = z[1:-1], y[1:-1]
    scatter = _scatter(z, y**2, 2 * y)
    half = max(int(np.argmax(y)) + 1, len(y) // 2)
    z, y = z[:half], y[:half]
    middle = -element / 2
    slope = y[0] ** 2 / (z[0] - middle)
    places = np.concatenate([[middle], z])
    squares = np.concatenate([[0.0], y**2])
    mesh_error = MESH * y * (element / (z - middle)) ** DECAY
    sd = np.concatenate([[slope * BRACKET * element], 2 * y * np.hypot(scatter, mesh_error)])

    def edge_of(b: Any, covariance: Any, length: float) -> Any:
        return _root(b, covariance, length, middle, AWAY * element)

    found = _chosen(places, squares, sd, DEGREES, 1, edge_of)
    if found is None:
        return _no_pressure(
            "no range of nodes follows the square-root law: the mesh is too coarse, a kink lies "
            "next to the edge, or the contact is complete",
            half,
        )
    (edge, K_N, L_N), errors = found.values, found.errors
    warning = _warning(half, found.misfit, errors[1] / K_N, "K_N")
    stretch = float(z[found.used - 1] - edge)
    return PressureFit(
        float(x[first] + sense * edge),
        float(K_N),
        float(L_N),
        float(errors[0]),
        float(errors[1]),
        float(errors[2]),
        found.used,
        stretch,
        found.degree,
        found.misfit,
        _why(found, "p**2", half),
        warning,
    )


def fit_stuck_shear(x: Array, dq: Array, edge: float, edge_error: float = 0.0) -> ShearFit:
    """K_T and L_T of an edge, from the change in shear traction in a run without slip.

    Parameters
    ----------
    x : array_like
        Positions of the nodes along the interface, increasing or decreasing [m].
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
    ValueError
        If the arguments are not a table, or if the edge does not lie next to its first node.

    Notes
    -----
    Nodes outside the edge, and the node of the element in which the contact ends, are left out.

    Examples
    --------
    >>> x = np.linspace(-1, 1, 64)[1:-1]
    >>> found = fit_stuck_shear(x, 1 / np.sqrt(1 - x**2), -1.0)
    >>> f"K_T = {found.K_T:.3f}"  # 1/sqrt(2) = 0.7071
    'K_T = 0.707'
    """
    x, dq = _table(x, dq, "dq")
    edge, edge_error = float(edge), float(edge_error)
    if not (math.isfinite(edge) and edge_error >= 0 and math.isfinite(edge_error)):
        raise ValueError(
            "edge and edge_error must be finite numbers in metres, and edge_error must not be "
            "negative; got "
            f"{edge}, {edge_error}"
        )
    sense = 1.0 if x[-1] > x[0] else -1.0
    s = sense * (x - edge)
    spacing = float(np.median(np.diff(s)))
    within = s >= spacing / 2
    if s[0] > 3 * spacing or not np.any(s > 0):
        raise ValueError(
            f"the edge at {edge:.6g} does not lie next to the first of the nodes, {x[0]:.6g} to "
            f"{x[-1]:.6g}: give the nodes from this edge inward"
        )
    s, dq = s[within][1:], dq[within][1:]
    if len(s) < SPAN + 2:
        return _no_shear(
            f"{len(s) + 1} nodes inside the edge are too few: use a finer mesh", len(s)
        )

    y = dq * np.sqrt(s)
    level = np.full(len(y), float(np.median(np.abs(y))))
    half = max(len(y) // 2, SPAN)
    if not level[0] > 0:
        return _no_shear("the change in the shear traction is zero at most nodes", half)
    mesh_error = MESH * (spacing / s[:half]) ** DECAY
    sd = np.hypot(_scatter(s, y, level), mesh_error) * level[:half]
    found = _chosen(s[:half], y[:half], sd, STUCK, 0, _ends)
    if found is None:
        return _no_shear(
            "no range of nodes follows the square-root law: the mesh is too coarse, or there is "
            "slip",
            half,
        )
    values, errors = np.array(found.values), np.array(found.errors)
    if edge_error > 0:
        shift = min(edge_error, 0.9 * float(s[0]))
        shifted = [_fit_ends(s, dq, sign * shift, found) for sign in (-1, 1)]
        errors = np.hypot(errors, np.abs(shifted[1] - shifted[0]) / 2 * (edge_error / shift))
    part = abs(errors[0] / values[0]) if values[0] else math.inf
    warning = _warning(half, found.misfit, part, "K_T")
    return ShearFit(
        float(values[0]),
        float(values[1]),
        float(errors[0]),
        float(errors[1]),
        found.used,
        float(s[found.used - 1]),
        found.degree,
        found.misfit,
        _why(found, "dq sqrt(s)", half),
        warning,
    )


def K_N_from_loads(P: Array, M: Array, a: Array, c: Array) -> Edges:
    """K_N at both edges of any body's contact, from reaction forces at two neighbouring loads.

        K_N dedge = 2 (dP +/- 4 (dM + mid dP)/h)/(pi sqrt(h)), the upper sign at the left edge

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
    ValueError
        Unless each argument holds two loads.

    Notes
    -----
    Each argument holds the two loads along its last axis; the other axes broadcast.

    Examples
    --------
    >>> R, h = 2.0, np.array([1.99, 2.01])  # a cylinder, E* = 1: P = pi h**2/(16 R)
    >>> found = K_N_from_loads(np.pi * h**2 / (16 * R), 0.0 * h, h / 2, h / 2)
    >>> f"{found.left:.4f}"  # sqrt(h)/(2 R)
    '0.3536'
    """
    given = [np.asarray(real(v, name)) for v, name in ((P, "P"), (M, "M"), (a, "a"), (c, "c"))]
    if any(v.ndim == 0 or v.shape[-1] != 2 for v in given):
        shapes = ", ".join(str(v.shape) for v in given)
        raise ValueError(
            "P, M, a and c must each hold two values along their last axis, one for each load; "
            "their shapes are "
            f"{shapes}"
        )
    (dP, dM, da, dc) = (v[..., 1] - v[..., 0] for v in given)
    at_a, at_c = (v.mean(-1) for v in given[2:])
    with np.errstate(all="ignore"):
        h, mid = at_a + at_c, (at_c - at_a) / 2
        scale, turn = 2 / (np.pi * np.sqrt(h)), 4 * (dM + mid * dP) / h
        left, right = scale * (dP + turn) / da, scale * (dP - turn) / dc
        left, right = (np.where((K > 0) & (np.inf > K), K, np.nan)[()] for K in (left, right))
    return Edges(left, right)


# ---------------------------------------------------------------- choice of stretch and degree


def _chosen(
    places: Any, y: Any, sd: Any, degrees: tuple[int, ...], known: int, evaluate: Any
) -> _Chosen | None:
    """The values from the best stretch of nodes, with one degree more than the best degree.

    known: number of leading data points that are not nodes.
    evaluate: (coefficients, covariance, frame) -> values and their covariance, or None.
    """
    origin, length = places[known], float(places[-1] - places[known])
    u = (places - origin) / length

    def fit(degree: int, count: int) -> _Fit | None:
        rows = slice(0, count + known)
        weighted = np.vander(u[rows], degree + 1, increasing=True) / sd[rows, None]
        q, r = np.linalg.qr(weighted)
        diagonal = np.abs(np.diag(r))
        if not diagonal.min() > 1e-11 * diagonal.max():
            return None
        target = y[rows] / sd[rows]
        inverse = np.linalg.inv(r)
        b = inverse @ (q.T @ target)
        residual = target - weighted @ b
        evaluated = evaluate(b, inverse @ inverse.T, (origin, length))
        return evaluated and _Fit(
            degree, count, evaluated[0], evaluated[1], float(residual @ residual)
        )

    shortest = 2 if known else 3
    nodes = len(places) - known
    fits = [fit(k, n) for k in degrees for n in range(k + shortest, nodes + 1)]
    ranked = sorted(
        (one for one in fits if one),
        key=lambda one: one.misfit + 2 * (one.degree + nodes - one.used),
    )
    for one in ranked:
        more = fit(one.degree + 1, one.used)
        if more is None:
            continue
        freedom = one.used + known - one.degree - 1
        excess = one.misfit / freedom
        changed = more.values - one.values
        variance = np.diag(more.covariance) * max(excess, 1.0) + changed**2
        return _Chosen(
            more.values, _t(nodes) * np.sqrt(variance), more.degree, one.used, math.sqrt(excess)
        )
    return None


def _t(nodes: int) -> float:
    """Half of the two-sided 95 % quantile of Student's t for a scatter estimated from `nodes`."""
    freedom = max(nodes - 2, 3)
    return (1.960 + 2.372 / freedom + 2.823 / freedom**2 + 2.556 / freedom**3) / 2


def _scatter(places: Any, y: Any, level: Any) -> float:
    """Standard deviation of y over `level`, from cubics fitted to short stretches."""
    variances = []
    for i in range(len(places) - SPAN + 1):
        part = slice(i, i + SPAN)
        u = (places[part] - places[i]) / (places[i + SPAN - 1] - places[i])
        q, _ = np.linalg.qr(np.vander(u, LOCAL + 1) / level[part, None])
        residual = y[part] / level[part]
        residual = residual - q @ (q.T @ residual)
        variances.append(residual @ residual / (SPAN - LOCAL - 1))
    squared = float(np.quantile(variances, SHARE)) / EXPECTED
    # at least the rounding of the table
    return math.sqrt(squared) + 1e-13 * float(np.max(np.abs(y) / level))


def _root(b: Any, covariance: Any, frame: Any, middle: float, away: float) -> Any:
    """Edge, K_N and L_N of p**2 = sum b u**j, and their covariance; None if there is no edge."""
    origin, length = frame
    first, second, third = (polynomial.polyder(b, k) for k in (1, 2, 3))
    u = (middle - origin) / length
    for _ in range(40):
        slope = polynomial.polyval(u, first)
        if not slope > 0:
            return None
        step = polynomial.polyval(u, b) / slope
        u -= step
        if abs(step) < 1e-13:
            break
    edge = origin + u * length
    slope, bend, twist = (polynomial.polyval(u, of) for of in (first, second, third))
    if not (slope > 0 and abs(edge - middle) <= away):
        return None
    K = math.sqrt(slope / length)
    L = bend / length**2 / (4 * K)
    j = np.arange(len(b))
    powers = u ** np.arange(len(b), dtype=float)
    by_root = -powers / slope
    by_slope = j * np.concatenate([[0.0], powers[:-1]]) + bend * by_root
    by_bend = j * (j - 1) * np.concatenate([[0.0, 0.0], powers])[: len(b)] + twist * by_root
    by_K = by_slope / (2 * K * length)
    by_L = by_bend / (4 * K * length**2) - L / K * by_K
    rates = np.array([by_root * length, by_K, by_L])
    return np.array([edge, K, L]), rates @ covariance @ rates.T


def _ends(b: Any, covariance: Any, frame: Any) -> Any:
    """Value and slope of sum b u**j at the edge, s = 0, and their covariance."""
    origin, length = frame
    u = -origin / length
    powers = u ** np.arange(len(b), dtype=float)
    rises = np.arange(len(b)) * np.concatenate([[0.0], powers[:-1]]) / length
    rates = np.array([powers, rises])
    return rates @ b, rates @ covariance @ rates.T


def _fit_ends(s: Any, dq: Any, at: float, like: _Chosen) -> Any:
    """K_T and L_T for another position of the edge, over the same stretch."""
    places = s[: like.used] - at
    b = polynomial.polyfit(places, dq[: like.used] * np.sqrt(places), like.degree)
    return np.array([b[0], b[1]])


# ---------------------------------------------------------------- tables and messages


def _table(x: Any, values: Any, name: str) -> tuple[Any, Any]:
    """Both columns as numbers, with x increasing or decreasing.

    Raises ValueError if they are not a table.
    """
    x, values = np.asarray(real(x, "x")), np.asarray(real(values, name))
    if x.ndim != 1 or values.shape != x.shape:
        raise ValueError(
            f"x and {name} must be rows of equal length; their shapes are {x.shape} and "
            f"{values.shape}"
        )
    if len(x) < 2:
        raise ValueError(f"x and {name} must hold at least two nodes; got {len(x)}")
    for column, label in ((x, "x"), (values, name)):
        if not np.all(np.isfinite(column)):
            at = np.flatnonzero(~np.isfinite(column))[0]
            raise ValueError(f"{label} is {column[at]} at node {at + 1}: give finite numbers only")
    steps = np.diff(x)
    if np.any(steps == 0):
        at = np.flatnonzero(steps == 0)[0]
        raise ValueError(f"two nodes lie at x = {x[at]:.6g}: give each node once")
    if not (np.all(steps > 0) or np.all(steps < 0)):
        at = np.flatnonzero(np.sign(steps) != np.sign(steps[0]))[0]
        raise ValueError(f"x changes its direction after node {at + 1}: sort the nodes along x")
    return x, values


def _why(found: _Chosen, what: str, nodes: int) -> str:
    return (
        f"{what} fits a polynomial of degree {found.degree - 1} over {found.used} of {nodes} nodes "
        f"with a misfit of {found.misfit:.2g} times its scatter; degree {found.degree} is used"
    )


def _warning(nodes: int, misfit: float, part: float, name: str) -> str:
    """Reasons to doubt a result."""
    reasons = []
    if nodes < LEAST:
        reasons.append(
            f"there are only {nodes} nodes between the edge and the middle of the contact, and "
            "errors may be larger than stated: use a finer mesh"
        )
    if misfit**2 > WORST:
        reasons.append(
            f"no range of nodes follows the square-root law (misfit {misfit:.1f} times the "
            "scatter): the mesh is too coarse, or there is a kink"
            + (" or slip next to the edge" if name == "K_T" else " next to the edge")
        )
    if not part < POOR:
        reasons.append(f"{name} is known only to within {100 * part:.0f} %")
    return "; ".join(reasons)


def _no_pressure(why: str, nodes: int) -> PressureFit:
    none = math.nan
    return PressureFit(none, none, none, none, none, none, nodes, none, 0, none, "", why)


def _no_shear(why: str, nodes: int) -> ShearFit:
    none = math.nan
    return ShearFit(none, none, none, none, nodes, none, 0, none, "", why)
