"""Functions shared by the notebooks: cycles, the coefficients of the paper, text, tables, figures.

A notebook runs in this folder and uses ``from common import ...``.  This module makes the rest of
the checkout importable.
"""

import re
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from IPython.display import Markdown, display
from scipy.optimize import brentq
from sympy import lambdify, symbols

ROOT = Path(__file__).resolve().parents[1]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from derive import plot  # noqa: E402
from derive.check.userfile import built_in as paper  # noqa: E402
from derive.sheet.prose import prose  # noqa: E402

Array = Any


# ------------------------------------------------------------------ tension


def closing_tension(body: ModuleType, contact: Any, dQ: float, *, f: float, **law: float) -> Any:
    """The changes in bulk tension, down and up, at which one slip zone closes at constant loads.

    In the moderate solution [-m, n] carries P - dQ/(2 f) at the tilt alpha - dsigma/(4 f E*).  Up,
    its right edge is that of the contact: load(m, c) determines m, and tilt(m, c) dsigma.
    """
    a, c = float(contact.a), float(contact.c)
    reduced = float(body.load(a, c, **law)) - dQ / (2 * f)
    own = {name: value for name, value in law.items() if name != "E_star"}

    def tension(edges: Callable[[float], tuple[float, float]]) -> float:
        def excess(width: float) -> float:  # what does not reach the body carries nothing
            return float(np.nan_to_num(body.load(*edges(width), **law))) - reduced

        kept = edges(brentq(excess, 1e-9 * (a + c), a + c, xtol=1e-15 * (a + c), rtol=1e-15))
        return float(4 * f * law["E_star"] * (body.tilt(a, c, **own) - body.tilt(*kept, **own)))

    return tension(lambda width: (a, width - a)), tension(lambda width: (width - c, c))


# ------------------------------------------------------------------ texts


def say(text: str) -> None:
    """Show Markdown that contains numbers computed by the notebook."""
    display(Markdown(text))


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> None:
    """Show a table; the first `words` columns are aligned left, the others right."""
    rule = ["---"] * words + ["---:"] * (len(heads) - words)
    say("\n".join("| " + " | ".join(row) + " |" for row in (heads, rule, *rows)))


def in_cell(latex: str) -> str:
    """LaTeX for a cell of a table, in which a plain | would end the cell."""
    for side in ("left", "right", "middle"):
        latex = latex.replace(rf"\{side}|", rf"\{side}\vert ")
    return rf"$\displaystyle {latex}$"


def plainly(text: str) -> str:
    """Text for Markdown, with its formulas typeset and *, | and _ escaped.

    >>> plainly("P = (E*/2) I_1, the coefficient of s**(3/2)")
    'P = (E\\\\*/2) I<sub>1</sub>, the coefficient of s<sup>3/2</sup>'
    """
    return re.sub(r"[*_|]", r"\\\g<0>", prose(text))


def percent(part: float, digits: int = 2) -> str:
    """A fraction in per cent with a sign; a value due to rounding is shown as 0 %.

    >>> percent(0.2341), percent(-3e-15), percent(float("nan"))
    ('+23 %', '0 %', '-')
    """
    if not np.isfinite(part):
        return "-"
    return f"{100 * part:+.{digits}g} %" if abs(part) > 1e-9 else "0 %"


def small(value: float) -> str:
    """A difference that should be zero: its size, or "rounding" if it is no larger than that.

    >>> small(3e-15), small(0.02)
    ('rounding', '2e-02')
    """
    return "rounding" if abs(value) < 1e-11 else f"{value:.0e}"


# ------------------------------------------------------------------ cycles


class Cycle(NamedTuple):
    """All four loads over a cycle, in phase; Q rises from its minimum and returns to it."""

    t: Array
    P: Array
    M: Array
    Q: Array
    sigma: Array

    @property
    def loads(self) -> tuple[Array, Array, Array, Array]:
        """The loads in the order of the arguments of `march`."""
        return self.P, self.M, self.Q, self.sigma


def cycle(
    P: tuple[float, float],
    M: tuple[float, float],
    dQ: float,
    dsigma: float,
    count: int = 401,
) -> Cycle:
    """Loads that vary between two states like a cosine, at an odd number `count` of instants."""
    t = np.linspace(0, 1, count)
    part = (1 - np.cos(2 * np.pi * t)) / 2
    P_t, M_t = (ends[0] + part * (ends[1] - ends[0]) for ends in (P, M))
    return Cycle(t, P_t, M_t, (part - 0.5) * dQ, (part - 0.5) * dsigma)


# ------------------------------------------------------------------ coefficients of the paper


class Ends(NamedTuple):
    """A stick zone [-m, n]; at an instant of a cycle, left and right are the senses of slip."""

    m: Array
    n: Array
    left: Array = 0
    right: Array = 0


@cache
def _printed_K_T() -> tuple[Callable[..., Array], Callable[..., Array]]:
    """Delta K_T of eq. (32) with the half-widths as in the paper, from its claims."""
    claims = (paper()[f"K_T/tilted/{side}"] for side in ("left", "right"))
    Delta_Q, Delta_sigma, a, c = symbols("Delta_Q Delta_sigma a c")
    left, right = (
        lambdify((Delta_Q, Delta_sigma, own), claim.meant.right, "numpy")
        for claim, own in zip(claims, (a, c), strict=True)
    )
    return left, right


def printed(
    body: ModuleType,
    contact: Any,
    dQ: Array,
    dsigma: Array,
    *,
    f: float,
    da: Array = 0.0,
    dc: Array = 0.0,
    **constants: float,
) -> Ends:
    """The stick zone by eq. (20), d = |K_T|/(f K_N) + da/2, with K_T by eq. (32) as printed.

    da, dc: outward motion of the left and right edge since slip began, negative if inward.
    """
    left, right = _printed_K_T()
    K_N = body.K_N(contact.a, contact.c, **constants)
    d_left = np.abs(left(dQ, dsigma, contact.a)) / (f * K_N.left) + da / 2
    d_right = np.abs(right(dQ, dsigma, contact.c)) / (f * K_N.right) + dc / 2
    return Ends(contact.a - d_left, contact.c - d_right)


KINDS = ("printed", "order 1", "order 2")
"""Series that the figures compare with the exact stick zone."""


def series(
    body: ModuleType,
    contact: Any,
    dQ: Array,
    dsigma: Array,
    *,
    f: float,
    da: Array = 0.0,
    dc: Array = 0.0,
    **constants: float,
) -> dict[str, Ends]:
    """Stick zones by each of the series."""
    zones = {"printed": printed(body, contact, dQ, dsigma, f=f, da=da, dc=dc, **constants)}
    for order in (1, 2):
        d = body.slip_zones(
            *(contact.a, contact.c, dQ, dsigma),
            **{"f": f, "da": da, "dc": dc, "order": order, **constants},
        )
        zones[f"order {order}"] = Ends(contact.a - d.left, contact.c - d.right)
    return zones


def series_march(body: ModuleType, of: Cycle, *, f: float, **constants: float) -> dict[str, Ends]:
    """The stick zone by each of the series at every instant of a cycle.

    The changes at an instant are counted from the last instant at which slip began.
    """
    at = body.contact(of.P, of.M, **constants)
    middle = of.t.size // 2
    start = np.where(np.arange(of.t.size) <= middle, 0, middle)
    rising = np.where(start == 0, 1, -1)
    changes = (rising * (load - load[start]) for load in (of.Q, of.sigma))
    moved = {"da": at.a - at.a[start], "dc": at.c - at.c[start]}
    found = series(body, at, *changes, f=f, **moved, **constants)
    return {kind: Ends(zone.m, zone.n, rising, rising) for kind, zone in found.items()}


# ------------------------------------------------------------------ figures


def march_figure(
    axes: Any, body: ModuleType, of: Cycle, *, f: float, length: plot.Measure, **constants: float
) -> Any:
    """Draw the map of a cycle by the exact conditions, with the three series as lines.

    Returns the result of `march`.
    """
    exact = body.march(*of.loads, f=f, **constants)
    plot.stick_slip(exact, of.t, axes=axes, length=length)
    for kind, zones in series_march(body, of, f=f, **constants).items():
        plot.boundaries(axes, of.t, zones, kind, length=length)
    axes.set_xlabel("$t/T$")
    return exact


def errors_at(edges: Any, exact: Any, found: dict[str, Ends]) -> dict[str, tuple[Array, Array]]:
    """Errors of the slip zones of each series, relative to the exact slip zones."""
    d_left, d_right = edges.a - exact.m, edges.c - exact.n
    with np.errstate(all="ignore"):
        return {
            kind: ((edges.a - ends.m) / d_left - 1, (edges.c - ends.n) / d_right - 1)
            for kind, ends in found.items()
        }


def error_lines(
    axes: Sequence[Any], at: Array, errors: dict[str, tuple[Array, Array]], label: str
) -> None:
    """Draw the errors in per cent, those at the left and the right edge in separate axes."""
    with plot.style():
        for side, panel in enumerate(axes):
            panel.axhline(0, color="#555555", linewidth=0.8)
            for kind, both in errors.items():
                panel.plot(at, 100 * both[side], label=kind, **plot.LINES[kind])
            edge = ("left", "right")[side]
            panel.set(xlabel=label, ylabel=f"error of $d$, {edge} edge  [%]")
        axes[0].legend()
