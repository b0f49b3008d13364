"""Contacts of a body whose edges have the coefficients and displacements requested.

The body enters only by its functions of (a, c), which are explicit: `of(name, a, c, parameters)`.
`requested` holds the data of one or both edges by side.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

MATCH_RTOL = 1e-8
"""Relative deviation below which a request counts as met."""


def contact_of(
    of: Callable[..., Any], requested: Mapping[str, Any], law: dict[str, float], free: str | None
) -> tuple[float, float, dict[str, float]]:
    """The widest contact whose edges are as requested, and the body's parameters.

    The unknowns u are log h, mid/h, and the logarithm of the free parameter.
    """
    alone = len(requested) == 1

    def place(u: Any) -> tuple[Any, Any, dict[str, Any]]:
        h, lean = np.exp(u[..., 0]), u[..., 1]
        return h * (0.5 - lean), h * (0.5 + lean), law | ({free: np.exp(u[..., 2])} if free else {})

    def residual(u: Any) -> Any:
        a, c, own = place(u)
        K_N, L_N, rows = of("K_N", a, c, own), of("L_N", a, c, own), []
        for side, one in requested.items():
            rows.append(np.log(getattr(K_N, side) / one.K_N))
            if free and one.L_N is not None:
                rows.append((getattr(L_N, side) - one.L_N) * (a + c) / one.K_N)
        if alone:
            rows.append(of("moment", a, c, own) / (of("load", a, c, own) * (a + c)))
        return np.stack(np.broadcast_arrays(*rows), -1)

    axes = [np.log(np.geomspace(1e-9, 1e6, 121)), np.linspace(-0.45, 0.45, 7)]
    axes += [np.log(np.geomspace(1e-6, 1e6, 37))] if free else []
    found = _least_squares(residual, *axes)
    # the widest contact; among equally wide ones the one closest to symmetric
    met = [u for u, miss in found if miss < MATCH_RTOL]
    if met:
        a, c, own = place(max(met, key=lambda u: (round(u[0], 6), -abs(u[1]))))
        return float(a), float(c), {name: float(value) for name, value in own.items()}
    near = ""
    if found:
        at = place(found[0][0])
        (K, K_2), (L, L_2) = of("K_N", *at), of("L_N", *at)
        near = f"; of the nearest one, left and right, K_N = {K:.6g} and {K_2:.6g}"
        near += f", L_N = {L:.6g} and {L_2:.6g}" if free else ""
    raise ValueError(
        f"no contact{' with M = 0' if alone else ''} has the coefficients requested{near}: use "
        f"other parameters or another body{'' if alone else ', or match one edge alone'}"
        f"{f', or give {free} in place of L_N' if free else ''}"
    )


def start_of(
    of: Callable[..., Any], requested: Mapping[str, Any], law: dict[str, float], a: float, c: float
) -> tuple[float, float]:
    """The contact at the start of the half-cycle, with edges further in by their displacements."""
    from scipy.optimize import root_scalar

    moves = {side: one.da for side, one in requested.items()}
    a_1, c_1 = a - moves.get("left", 0.0), c - moves.get("right", 0.0)
    if len(moves) == 1 and any(moves.values()):

        def edges(h: float) -> tuple[float, float]:
            return (a_1, h - a_1) if "left" in moves else (h - c_1, c_1)

        def lever(h: float) -> Any:
            return of("moment", *edges(h), law) / of("load", *edges(h), law)

        h = a + c - 2 * sum(moves.values())
        found = root_scalar(lever, x0=h, x1=1.001 * h, xtol=1e-14 * (a + c))
        a_1, c_1 = edges(found.root if found.converged else math.nan)
    if not (a_1 + c_1 > 0 and of("load", a_1, c_1, law) > 0):
        raise ValueError(
            f"no load moves the edge of this body by {max(moves.values()):.6g} m at a contact "
            f"width of {a + c:.6g} m: use a larger body, or match one edge alone"
        )
    return float(a_1), float(c_1)


def _least_squares(residual: Callable[[Any], Any], *axes: Any) -> list[tuple[Any, float]]:
    """From the lowest points of a grid: the unknowns and the largest residual, the best first."""
    from scipy.ndimage import minimum_filter
    from scipy.optimize import least_squares

    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    with np.errstate(all="ignore"):
        cost = np.nan_to_num(np.sum(residual(grid) ** 2, -1), nan=np.inf)
        lowest = (cost == minimum_filter(cost, 3)) & (cost < np.inf)
        starts = grid[lowest][np.argsort(cost[lowest], kind="stable")[:16]]
        found = [least_squares(residual, u, xtol=1e-15, ftol=1e-15, gtol=1e-15) for u in starts]
    pairs = [(one.x, float(np.max(np.abs(one.fun)))) for one in found]
    return sorted(pairs, key=lambda pair: pair[1])
