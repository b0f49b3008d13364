"""The style of all pictures, applied in a context that leaves other pictures unchanged.

The colours are those of Okabe and Ito, which can be distinguished with any kind of colour vision.
Lines with different meanings also differ in their dashes.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

A = TypeVar("A")
"""Axes, or a sequence of Axes."""

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
"""The colours of successive lines."""

FORWARD, REVERSE, STICK = "#f3cf80", "#80b9d9", "#ececec"
"""The colours of areas: slip in the direction of a positive dQ, slip against it, and stick."""

LINES: dict[str, dict[str, Any]] = {
    "exact": {"color": COLOURS["black"], "linestyle": "-", "linewidth": 1.4},
    "printed": {"color": COLOURS["purple"], "linestyle": "-.", "linewidth": 1.6},
    "order 1": {"color": COLOURS["vermilion"], "linestyle": "--", "linewidth": 1.6},
    "order 2": {"color": COLOURS["green"], "linestyle": ":", "linewidth": 2.4},
    "solver": {"color": COLOURS["black"], "linestyle": "", "marker": "o", "markersize": 3.5},
}
"""The line styles of each kind of result, the same in every picture."""

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
    """Apply the style of this package to pictures that are drawn inside ``with style():``.

    Unlike the context manager of matplotlib, this one restores only the settings that it has
    changed.  A notebook that makes its first figure inside the block sets up its display there, and
    these settings must remain.

    Returns
    -------
    context manager
        To be used in a `with` statement.
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
    """Make a figure and its Axes in this style, like `subplots` of matplotlib.

    Parameters
    ----------
    rows, columns : int, optional
        Numbers of rows and columns of Axes.
    size : tuple of float, optional
        Width and height of the figure in inches.
    titles : sequence of str, optional
        The titles of the Axes, row by row.
    **more
        Other arguments of `matplotlib.pyplot.subplots`.

    Returns
    -------
    figure : Figure
        The figure.
    axes : Axes or ndarray of Axes
        As `matplotlib.pyplot.subplots` returns them.
    """
    with style():
        figure, axes = plt.subplots(
            rows, columns, figsize=size or (4.6 * columns, 3.2 * rows), **more
        )
        for each, title in zip(figure.axes, titles, strict=False):
            each.set_title(title)
    return figure, axes


@contextmanager
def canvas(axes: A | None, rows: int = 1, size: tuple[float, float] | None = None) -> Iterator[A]:
    """Draw inside this context, in this style: into the Axes of the caller, or into new ones."""
    with style():
        yield subplots(rows, 1, size=size, sharex=True)[1] if axes is None else axes


def save(figure: Figure, path: str | Path) -> None:
    """Write a picture as a reproducible file, in the format given by the suffix of its path.

    Parameters
    ----------
    figure : Figure
        The picture.
    path : str or Path
        The file, such as slip.pdf; the folder must exist.

    Raises
    ------
    ValueError
        If matplotlib does not know the format.
    OSError
        If the file cannot be written.
    """
    suffix = Path(path).suffix
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with style():
        figure.savefig(path, metadata=dated.get(suffix, {}), dpi=150)
