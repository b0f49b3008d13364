"""Sliders for the loads in a notebook, with a picture of contact, tractions and slip zones.

`Live` draws the picture and does not depend on the sliders; `sliders` adds them to the picture.
"""

from importlib.util import find_spec
from io import BytesIO
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from derive.command.errors import MissingLibrary
from derive.plot.measure import Array, Measure, unit
from derive.plot.style import style
from derive.plot.tractions import peak, tractions
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


SCALES = {"P": "N/m", "M": "N", "dQ": "N/m", "dsigma": "Pa", "f": "-"}
"""The SI unit of each load."""


class Live:
    """A picture of a steady cycle under constant normal loads, which can be redrawn in place.

    The axes are moved or widened for a contact beyond their limits, such as one under M and a small
    P.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    largest : Loads
        The largest loads; the axes show the contacts under their P and M, and under P and -M.
    **constants : float
        E_star [Pa] and the parameters of the body.

    Raises
    ------
    ValueError
        If a load is not finite, or if the body cannot carry the largest loads.
    """

    def __init__(self, body: ModuleType, largest: Loads, **constants: float) -> None:
        _demand_largest(largest)
        self.body, self.constants = body, constants
        moments = np.array([largest.M, -largest.M])
        farthest = body.contact(largest.P, moments, **constants)
        if not np.any(np.isfinite(farthest.a)):
            raise ValueError(
                f"there is no contact under largest.P = {largest.P:g} and largest.M = "
                f"{largest.M:g} of either sign; give loads that the body can carry"
            )
        self.reach = 1.04 * float(np.nanmax([farthest.a, farthest.c]))
        self.top = 1.6 * largest.P / float(np.nanmin(farthest.a + farthest.c))
        self.length, self.stress = unit(self.reach, "m"), unit(self.top, "Pa")
        with style():
            self.figure = Figure(figsize=(8.4, 4.8), dpi=200)
            self.figure.set_layout_engine("none")  # because computing a new layout takes long
            place = {"left": 0.09, "right": 0.98, "bottom": 0.11, "top": 0.93, "hspace": 0.25}
            self.axes = self.figure.subplots(2, 1, sharex=True, gridspec_kw=place)

    def show(self, loads: Loads) -> str:
        """Draw the cycle under these loads.

        Parameters
        ----------
        loads : Loads
            The loads of the cycle.

        Returns
        -------
        str
            A description of the cycle in one line.
        """
        for axes in self.axes:
            axes.clear()
        P, M, dQ, dsigma, f = loads
        state = self.body.contact(P, M, **self.constants)
        if not np.isfinite(state.a):
            return "no contact: the body cannot carry these loads"
        law: Any = {"f": f, **self.constants}
        units: Any = {"length": self.length, "stress": self.stress}
        tractions(self.body, state, state, dQ, dsigma, axes=self.axes, **units, **law)
        self._set_limits(state, f)
        zone = self.body.stick_zone(state, state, dQ, dsigma, **law)
        threshold = self.body.tension_threshold(state, state, dQ, **law).upper
        return self._described(state, zone, threshold)

    def _set_limits(self, state: Any, f: float) -> None:
        """Set the limits of the axes to those of the largest loads.

        They are moved or widened if the contact is outside them.  The peak at a corner is cut off.
        """
        margin = self.reach / 26
        left, right = -float(state.a) - margin, float(state.c) + margin
        wide = max(2 * self.reach, right - left)
        low = min(max(-self.reach, right - wide), left)
        above, below = self.axes
        height, top = 1.08 * peak(above.get_lines()[-1].get_ydata()), float(self.stress(self.top))
        above.set_ylim(0, max(top, height))
        below.set_ylim(-max(top, 2 * f * height), max(top, 2 * f * height))
        below.set_xlim(float(self.length(low)), float(self.length(low + wide)))

    def _described(self, state: Any, zone: Any, threshold: Array) -> str:
        def lengths(*values: Array) -> str:
            return ", ".join(f"{float(self.length(value)):.4f}" for value in values)

        regime, name = regime_in_words(self.body, zone), self.length.name
        parts = [f"{regime}: contact [{lengths(-state.a, state.c)}] {name}"]
        parts.append(f"tilt {1e3 * float(state.alpha):.3f} mrad")
        if np.isfinite(zone.m):
            parts.append(f"stick [{lengths(-zone.m, zone.n)}] {name}")
            parts.append(f"slip {lengths(state.a - zone.m)} and {lengths(state.c - zone.n)} {name}")
        if np.isfinite(threshold):
            moderate = unit(threshold, "Pa")
            parts.append(f"tension is moderate up to {moderate(threshold):.4g} {moderate.name}")
        return "; ".join(parts)

    def png(self) -> bytes:
        """The current picture.

        Returns
        -------
        bytes
            A file in the format PNG.
        """
        target = BytesIO()
        with style():
            FigureCanvasAgg(self.figure).print_png(target)  # type: ignore[no-untyped-call]
        return target.getvalue()


def _demand_largest(largest: Loads) -> None:
    """Demand ends of the sliders that are finite and not negative; P, dQ and f must be positive."""
    for name, value in largest._asdict().items():
        positive = name in ("P", "dQ", "f")
        allowed = "a finite positive number" if positive else "a finite number that is not negative"
        right = np.ndim(value) == 0 and np.isfinite(value) and value >= 0
        if not right or (positive and value == 0):
            raise ValueError(
                f"largest.{name} is {value}, but the end of a slider must be {allowed}; give one"
            )


def sliders(body: ModuleType, largest: Loads, start: Loads, **constants: float) -> Any:
    """Sliders for the loads, and a picture that follows them.

    Parameters
    ----------
    body : module
        A generated module, such as generated.wedge.
    largest : Loads
        The loads at the ends of the sliders.
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
        If a load is not allowed at the end of a slider, or `start` is outside the sliders.
    """
    if find_spec("ipywidgets") is None:
        raise MissingLibrary("ipywidgets", "changing the loads with sliders", "notebooks")
    import ipywidgets

    live = Live(body, largest, **constants)
    picture, line = ipywidgets.Image(format="png", width=840), ipywidgets.HTML()
    controls, sizes = [], []
    for (name, of), most, value in zip(SCALES.items(), largest, start, strict=True):
        least = -most if name in ("M", "dsigma") else 0.0
        if np.ndim(value) or not least <= value <= most:
            raise ValueError(
                f"start.{name} is {value}, but its slider covers {least:g} to {most:g}; give a "
                f"number in this range, or increase largest.{name}"
            )
        least = most / STEPS if name in ("P", "f") else least  # these are never zero
        measure = unit(most, of) if of != "-" else Measure(1.0, of)
        sizes.append(measure.size)
        slider = ipywidgets.FloatSlider(
            value=value / measure.size,
            min=least / measure.size,
            max=most / measure.size,
            step=most / measure.size / STEPS,
            description=f"{name} [{measure.name}]",
            readout_format=".4g",
            style={"description_width": "100px"},
            layout={"width": "400px"},
        )
        controls.append(slider)

    def follow(_: Any = None) -> None:
        values = (slider.value * size for slider, size in zip(controls, sizes, strict=True))
        line.value = live.show(Loads(*values))
        picture.value = live.png()

    for slider in controls:
        slider.observe(follow, names="value")
    follow()
    row = ipywidgets.HBox(controls, layout={"flex_flow": "row wrap"})
    return ipywidgets.VBox([row, picture, line])
