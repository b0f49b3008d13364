"""Small pictures of curves as elements of a page, drawn by matplotlib.

The page needs nothing else to show them.  Their grey axes are legible on light and on dark pages.
"""

import io
import math
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from derive.command.errors import MissingLibrary

if find_spec("matplotlib") is None:
    raise MissingLibrary("matplotlib", "a page with pictures", "handbook")

import matplotlib as mpl
import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

_GREY = "#7f7f7f"
_STYLE: Any = {
    **{"svg.fonttype": "none", "svg.hashsalt": "picture", "font.size": 9, "text.color": _GREY},
    **dict.fromkeys(("axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color"), _GREY),
    **{"axes.grid": True, "grid.color": _GREY, "grid.alpha": 0.3},
}


@dataclass(frozen=True)
class Line:
    """One curve: its label in the legend, its points, and its look as a format of matplotlib."""

    label: str
    x: Sequence[float] | np.ndarray
    y: Sequence[float] | np.ndarray
    look: str = "-"


def curves(
    title: str,
    along: str,
    upward: str,
    lines: Sequence[Line],
    top: float = math.inf,
    is_log: bool = False,
) -> Markup:
    """Curves in one pair of axes, with a legend if there are several, cut off at the height `top`.

    is_log: whether both axes are logarithmic
    """
    with mpl.rc_context(_STYLE):
        figure = Figure((7.2, 3.2), layout="constrained")
        axes = figure.subplots()
        _draw(axes, lines)
        axes.set(xlabel=along, ylabel=upward)
        if is_log:
            axes.set(xscale="log", yscale="log")
        else:
            axes.set_ylim(top=min(top, 1.05 * max(np.max(line.y) for line in lines)))
        if len(lines) > 1:
            axes.legend(frameon=False)
        return _shown(figure, title)


def sketch(title: str, line: Line) -> Markup:
    """One curve without axes, in a small box."""
    with mpl.rc_context(_STYLE):
        figure = Figure((1.75, 0.67), layout="constrained")
        axes = figure.subplots()
        _draw(axes, [line])
        axes.axis("off")
        return _shown(figure, title)


def _draw(axes: Axes, lines: Sequence[Line]) -> None:
    for line in lines:
        axes.plot(line.x, line.y, line.look, label=line.label)


def _shown(figure: Figure, title: str) -> Markup:
    """The picture as an element of a page, the same in every run."""
    written = io.BytesIO()
    figure.savefig(written, format="svg", transparent=True, metadata={"Date": None})
    source = f"data:image/svg+xml;base64,{b64encode(written.getvalue()).decode()}"
    return Markup('<img alt="{}" src="{}">').format(title, source)
