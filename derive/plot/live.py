"""Sliders for the loads in a notebook, with a picture of contact, tractions and slip zones."""

from importlib.util import find_spec
from io import BytesIO
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from derive.command.errors import MissingLibrary
from derive.plot.measure import unit
from derive.plot.style import style
from derive.plot.tractions import tractions
from derive.plot.zones import regime_in_words

STEPS = 200
"""Number of steps of a slider from zero to the largest load."""


class Loads(NamedTuple):
    """The loads that the sliders set.

    Parameters
    ----------
    P : float
        Normal load [N/m].
    M : float
        Moment [N].
    dQ : float
        Change in the shear load over a half-cycle [N/m].
    dsigma : float
        Change in the bulk tension over a half-cycle [Pa].
    f : float
        Coefficient of friction [-].
    """

    P: float
    M: float
    dQ: float
    dsigma: float
    f: float


UNITS = {"P": "N/m", "M": "N", "dQ": "N/m", "dsigma": "Pa", "f": "-"}
"""The SI unit of each load."""


class _Picture:
    """A picture of a steady cycle under constant normal loads, which can be redrawn in place.

    The axes show the contacts under the largest P and either sign of the largest M; they are
    widened for a contact beyond their limits, such as one under M and a small P.
    """

    def __init__(self, body: ModuleType, largest: Loads, constants: dict[str, float]) -> None:
        self.body, self.constants = body, constants
        farthest = body.contact(largest.P, np.array([largest.M, -largest.M]), **constants)
        if not np.any(np.isfinite(farthest.a)):
            raise ValueError(f"the body cannot carry {largest}; give other largest loads")
        self.reach = 1.04 * float(np.nanmax([farthest.a, farthest.c]))
        mean = largest.P / float(np.nanmin(farthest.a + farthest.c))
        self.length, self.stress = unit(self.reach, "m"), unit(mean, "Pa")
        with style():
            self.figure = Figure(figsize=(8.4, 4.8), dpi=200)
            self.figure.set_layout_engine("none")  # because computing a new layout takes long
            place = {"left": 0.09, "right": 0.98, "bottom": 0.11, "top": 0.93, "hspace": 0.25}
            self.axes = self.figure.subplots(2, 1, sharex=True, gridspec_kw=place)

    def draw(self, loads: Loads) -> tuple[bytes, str]:
        """Draw the cycle under these loads: a file in the format PNG, and a line of text."""
        for axes in self.axes:
            axes.clear()
        P, M, dQ, dsigma, f = loads
        state = self.body.contact(P, M, **self.constants)
        line = "no contact: the body cannot carry these loads"
        if np.isfinite(state.a):
            law: Any = {"f": f, **self.constants}
            of_axes: Any = {"axes": self.axes, "length": self.length, "stress": self.stress}
            tractions(self.body, state, state, dQ, dsigma, **of_axes, **law)
            ends = [-self.reach, self.reach, -1.05 * state.a, 1.05 * state.c]
            self.axes[1].set_xlim(float(self.length(min(ends))), float(self.length(max(ends))))
            line = self._in_words(state, dQ, dsigma, law)
        target = BytesIO()
        with style():
            self.figure.savefig(target, format="png")
        return target.getvalue(), line

    def _in_words(self, state: Any, dQ: float, dsigma: float, law: dict[str, float]) -> str:
        """The regime, the contact, the stick zone and the slip zones in one line."""

        def lengths(*values: float) -> str:
            return ", ".join(f"{float(self.length(value)):.4f}" for value in values)

        zone, name = self.body.stick_zone(state, state, dQ, dsigma, **law), self.length.name
        line = f"{regime_in_words(self.body, zone)}: contact [{lengths(-state.a, state.c)}] {name}"
        line += f"; tilt {1e3 * float(state.alpha):.3f} mrad"
        if np.isfinite(zone.m):
            line += f"; stick [{lengths(-zone.m, zone.n)}] {name}"
            line += f"; slip {lengths(state.a - zone.m)} and {lengths(state.c - zone.n)} {name}"
        threshold = self.body.tension_threshold(state, state, dQ, **law).upper
        if np.isfinite(threshold):
            moderate = unit(threshold, "Pa")
            line += f"; tension is moderate up to {moderate(threshold):.4g} {moderate.name}"
        return line


def sliders(body: ModuleType, largest: Loads, start: Loads, **constants: float) -> Any:
    """Sliders for the loads, and a picture that follows them.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    largest : Loads
        The loads at the ends of the sliders, which must be positive.
    start : Loads
        The loads at which the sliders start.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Returns
    -------
    ipywidgets.VBox
        The sliders and the picture, to be shown in a notebook.

    Raises
    ------
    MissingLibrary
        If ipywidgets is not installed.
    ValueError
        If the body cannot carry the largest loads, or those at the start are beyond them.
    """
    if find_spec("ipywidgets") is None:
        raise MissingLibrary("ipywidgets", "changing the loads with sliders", "notebooks")
    import ipywidgets

    if not np.all(np.abs(start) <= np.asarray(largest)):
        raise ValueError(f"{start} is beyond the ends of the sliders, {largest}; give others")
    live = _Picture(body, largest, constants)
    picture, line = ipywidgets.Image(format="png", width=840), ipywidgets.HTML()
    measures = [unit(most, of) for most, of in zip(largest, UNITS.values(), strict=True)]
    controls = []
    for name, measure, most, value in zip(UNITS, measures, largest, start, strict=True):
        step = most / STEPS
        least = {"P": step, "f": step, "dQ": 0.0}.get(name, -most)  # P and f are never zero
        ends = {"min": least, "max": most, "step": step, "value": value}
        slider = ipywidgets.FloatSlider(
            **{end: number / measure.size for end, number in ends.items()},
            description=f"{name} [{measure.name}]",
            readout_format=".4g",
            style={"description_width": "100px"},
            layout={"width": "400px"},
        )
        controls.append(slider)

    def follow(_: Any = None) -> None:
        pairs = zip(controls, measures, strict=True)
        loads = Loads(*(slider.value * measure.size for slider, measure in pairs))
        picture.value, line.value = live.draw(loads)

    for slider in controls:
        slider.observe(follow, names="value")
    follow()
    row = ipywidgets.HBox(controls, layout={"flex_flow": "row wrap"})
    return ipywidgets.VBox([row, picture, line])
