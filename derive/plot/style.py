"""The look of every picture; nothing outside its context changes.

Colours are those of Okabe and Ito, which readers with any kind of colour vision tell apart; lines
that mean different things differ in their dashes, too.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

COLOURS = {
    "black": "#000000",
    "orange": "#e69f00",
    "sky": "#56b4e9",
    "green": "#009e73",
    "yellow": "#f0e442",
    "blue": "#0072b2",
    "vermilion": "#d55e00",
    "purple": "#cc79a7",
}

CYCLE = tuple(COLOURS[name] for name in ("blue", "orange", "purple", "green", "vermilion", "sky"))
"""In which order lines take their colours."""

FORWARD, REVERSE, STICK = "#f3cf80", "#80b9d9", "#ececec"
"""Areas: slip in the sense of a positive dQ, slip against it, and stick."""

LINES: dict[str, dict[str, Any]] = {
    "exact": {"color": COLOURS["black"], "linestyle": "-", "linewidth": 1.4},
    "printed": {"color": COLOURS["purple"], "linestyle": "-.", "linewidth": 1.6},
    "order 1": {"color": COLOURS["vermilion"], "linestyle": "--", "linewidth": 1.6},
    "order 2": {"color": COLOURS["green"], "linestyle": ":", "linewidth": 2.4},
    "order 3": {"color": COLOURS["blue"], "linestyle": (0, (6, 2, 1, 2, 1, 2)), "linewidth": 1.6},
    "solver": {"color": COLOURS["black"], "linestyle": "", "marker": "o", "markersize": 3.5},
}
"""What is drawn alike in every picture: results of one kind."""

_STYLE: Any = {
    "axes.grid": True,
    "axes.prop_cycle": mpl.rcsetup.cycler(color=CYCLE),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 10,
    "axes.labelsize": 10,
    "figure.constrained_layout.use": True,
    "figure.dpi": 100,
    "figure.facecolor": "white",
    "font.size": 10,
    "grid.alpha": 0.6,
    "grid.color": "#cccccc",
    "grid.linewidth": 0.6,
    "hatch.color": "#bbbbbb",
    "hatch.linewidth": 0.6,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "mathtext.fontset": "dejavusans",
    "svg.hashsalt": "contact-derive",
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
}


@contextmanager
def style() -> Iterator[None]:
    """The look of this package, for what is drawn inside ``with style():``.

    Unlike matplotlib's own context it puts back no more than it has changed: the first figure of a
    notebook is made inside, and what sets up its display must last.
    """
    before = {name: mpl.rcParams[name] for name in _STYLE}
    mpl.rcParams.update(_STYLE)
    try:
        yield
    finally:
        mpl.rcParams.update(before)


def subplots(
    rows: int = 1,
    columns: int = 1,
    *,
    size: tuple[float, float] | None = None,
    titles: Sequence[str] = (),
    **more: Any,
) -> tuple[Figure, Any]:
    """A figure and its Axes in this look, as of matplotlib's `subplots`.

    size    in inches
    titles  of the Axes, row by row
    """
    with style():
        figure, axes = plt.subplots(
            rows, columns, figsize=size or (4.6 * columns, 3.2 * rows), **more
        )
        for place, title in zip(figure.axes, titles, strict=False):
            place.set_title(title)
    return figure, axes


def save(figure: Figure, path: str | Path) -> None:
    """Write a picture whose bytes are the same each time; the suffix says in which format."""
    suffix = Path(path).suffix
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with style():
        figure.savefig(path, metadata=dated.get(suffix, {}), dpi=150)
