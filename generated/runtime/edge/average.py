"""The average of polynomials fitted to all ranges of nodes that begin next to an edge.

Each fit has two to five coefficients.  Akaike's weights, corrected for few nodes [1],

    exp(-misfit**2/2 - k - nodes left out - k (k + 1)/(nodes - k)),   k coefficients,

average over all of them [2].  The value of a fit is that with one coefficient more, and its
variance includes the square of this change, as an estimate of the next term.  The scatter of the
nodes is that about cubics over short ranges, most of which meet no kink.

[1] Hurvich, Tsai: Regression and time series model selection in small samples, Biometrika 76, 297
(1989).
[2] Jay, Neil: Bayesian model averaging for analysis of lattice field theory results, Phys. Rev. D
103, 114502 (2021).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

MIN_NODES = 24
"""Number of nodes in contact below which errors may be small by chance."""

MAX_GAP = 3.5
"""Distance of two nodes, over the larger of the distances next to it, above which nodes are
missing."""

MAX_ERROR = 0.075
"""Relative error of K above which a warning is given: half of all draws of a normal distribution
lie within two thirds of it, 5 %."""


def averaged(
    kind: Any,
    x: Any,
    s: Any,
    y: Any,
    rate: Any,
    mesh: Any,
    half: int,
    powers: Any,
    spread: float,
    read: Callable[[Any], Any],
) -> Any:
    """A record of the average of all fits to y, or of the reason why there is none.

    x        nodes of the contact
    s, y     distances of its inner nodes from the edge, and y = sum b_j (s/s[-1])**powers[j] there
    rate     derivative of y with respect to the traction
    mesh     standard deviation of the traction due to the mesh
    half     number of nodes that belong to this edge
    spread   standard deviation of b_0, which is zero in the mean
    read     coefficients of the edge as an analytic function of b; NaN if there are none
    """
    sd = rate * np.hypot(_scatter(s, y, rate), mesh)
    columns = (s / s[-1])[:, None] ** powers / sd[:, None]
    weighted = np.vstack([np.eye(1, len(powers)) / spread, columns[:half]])
    target = np.append(0.0, (y / sd)[:half])
    counts = np.unique(np.geomspace(3, half, 40).astype(int))
    used = np.arange(half + 1) <= counts[:, None]
    with np.errstate(all="ignore"):
        part = weighted * used[..., None] * np.tri(len(powers))[1:, None, None]  # two and more
        inverse = np.linalg.pinv(part)
        b = inverse @ target
        misfit = np.sum((used * target - (part @ b[..., None])[..., 0]) ** 2, axis=-1)
        # a step in the complex plane gives derivatives that are exact to rounding
        steps = 1e-30j * np.eye(len(powers))
        rates = np.stack([read((b + one).T).T.imag / 1e-30 for one in steps], axis=-1)
        values, variance = read(b.T).T, np.sum((rates @ inverse) ** 2, axis=-1)
        terms = np.arange(2, len(powers))[:, None]
        excess = misfit[:-1] / (counts + 1 - terms)
        # the fit with one coefficient more, and the change due to it
        variance = variance[1:] * np.maximum(excess, 1.0)[..., None] + np.diff(values, axis=0) ** 2
        exists = np.all(np.isfinite(variance), axis=-1) & (terms < counts)
        penalty = terms + half - counts + terms * (terms + 1) / (counts - terms)
        cost = np.where(exists, misfit[:-1] / 2 + penalty, np.inf)
    if not np.any(exists):
        return kind(
            nodes=half,
            warning="no range of nodes follows the square-root law: the mesh is too coarse, a kink "
            "or slip lies next to the edge, or the contact is complete",
        )
    best = np.unravel_index(np.argmin(cost), cost.shape)
    weights = np.exp(cost[best] - cost[exists])
    values, variance = values[1:][exists], variance[exists]
    mean = np.average(values, axis=0, weights=weights)
    errors = np.sqrt(np.average(variance + (values - mean) ** 2, axis=0, weights=weights))
    count, fitted, off = int(counts[best[1]]), int(best[0]) + 2, math.sqrt(excess[best])
    stretch, degree = float(s[count - 1]), int(powers[fitted - 1])
    why = (
        f"of all ranges of nodes and numbers of coefficients, {count} of {half} nodes and {fitted} "
        f"coefficients fit best, with a misfit of {off:.2g} times the scatter"
    )
    K, name = abs(mean[-2]), kind._fields[len(mean) - 2]
    warning = _warning(x, errors[-2] / K if K else math.inf, name)
    return kind(*mean.tolist(), *errors.tolist(), count, stretch, degree, off, why, warning)


def _warning(x: Any, part: float, name: str) -> str:
    """Reasons to doubt a result."""
    steps = np.abs(np.diff(x))
    beside = np.maximum(np.append(steps[1:], 0.0), np.append(0.0, steps[:-1]))
    gaps = np.flatnonzero(steps > MAX_GAP * beside)
    reasons = [f"nodes are missing between x = {x[i]:.6g} and {x[i + 1]:.6g}" for i in gaps]
    if len(x) < MIN_NODES:
        reasons.append(
            f"there are only {len(x)} nodes in contact, and errors may be larger than stated: use "
            "a finer mesh"
        )
    if not part < MAX_ERROR:
        reasons.append(f"{name} is known only to within {100 * part:.0f} %")
    return "; ".join(reasons)


def _scatter(s: Any, y: Any, rate: Any) -> float:
    """Standard deviation of the traction, from cubics fitted to six nodes each.

    At most two thirds of these ranges are assumed to meet a kink.
    """
    s, y, rate = (sliding_window_view(column, 6) for column in (s, y, rate))
    u = (s - s[:, :1]) / (s[:, -1:] - s[:, :1])
    q, _ = np.linalg.qr(u[..., None] ** np.arange(4) / rate[..., None])
    residual = y / rate
    residual = residual - np.einsum("nij,nkj,nk->ni", q, q, residual)
    variances = np.sum(residual**2, axis=1) / 2
    # the squares of two normal numbers have an exponential distribution
    rounding = 1e-13 * np.max(np.abs(y / rate))
    return float(np.sqrt(np.quantile(variances, 1 / 3) / -np.log(1 - 1 / 3)) + rounding)
