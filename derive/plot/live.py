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
from derive.plot.measure import Array, unit
from derive.plot.style import COLOURS, FORWARD, REVERSE, style
from derive.plot.tractions import peak
from derive.plot.zones import regime_in_words, senses

PLACES = 241
"""Number of points along the contact, small enough to draw without delay."""

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
            self.figure = Figure(figsize=(8.4, 4.6), dpi=200)
            # The layout is fixed, because computing a new one takes longer than drawing the axes.
            self.figure.set_layout_engine("none")
            self.canvas = FigureCanvasAgg(self.figure)
            self.below = self.figure.add_axes((0.09, 0.11, 0.89, 0.42))
            self.above = self.figure.add_axes((0.09, 0.56, 0.89, 0.42), sharex=self.below)
            self.above.tick_params(labelbottom=False)
            self._prepare()

    def _prepare(self) -> None:
        """Create the artists; `show` sets their data and the limits of the axes."""
        self.above.set(ylabel=self.stress.label("p"))
        self.below.set(xlabel=self.length.label("x"), ylabel=self.stress.label(r"\Delta q"))
        (self.pressure,) = self.above.plot([], [], color=COLOURS["blue"])
        grey: dict[str, Any] = {"color": "#888888", "linewidth": 1}
        (self.upper,) = self.below.plot([], [], label=r"$\pm 2 f p$", **grey)
        (self.lower,) = self.below.plot([], [], **grey)
        red: dict[str, Any] = {"color": COLOURS["vermilion"], "linewidth": 2}
        (self.shear,) = self.below.plot([], [], label=r"$\Delta q$", **red)
        self.below.legend(loc="lower right", ncols=2)
        self.spans = [
            axes.axvspan(0, 0, linewidth=0) for axes in (self.above, self.below) for _ in range(2)
        ]

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
        state = self.body.contact(loads.P, loads.M, **self.constants)
        law = {"f": loads.f, **self.constants}
        zone = self.body.stick_zone(state, state, loads.dQ, loads.dsigma, **law)
        angle = np.linspace(0, np.pi, PLACES + 1)
        x = (state.c - state.a) / 2 - (state.a + state.c) / 2 * np.cos(angle)
        p = self.body.pressure(x, state.a, state.c, **self.constants)
        dq = self.body.shear_change(x, state, state, loads.dQ, loads.dsigma, **law)
        for line, values in (
            (self.pressure, p),
            (self.upper, 2 * loads.f * p),
            (self.lower, -2 * loads.f * p),
            (self.shear, dq),
        ):
            line.set_data(self.length(x), self.stress(values))
        self._hold(state, p, loads.f)
        self._shade(state, zone, loads.dsigma)
        return self._described(state, zone, loads)

    def _hold(self, state: Any, p: Array, f: float) -> None:
        """Set the limits of the axes to those of the largest loads.

        They are moved or widened if the contact is outside them.  The peak at a corner is cut off.
        """
        low, high = -self.reach, self.reach
        if np.isfinite(state.a):
            margin = self.reach / 26
            left, right = -float(state.a) - margin, float(state.c) + margin
            wide = max(2 * self.reach, right - left)
            low = min(max(low, right - wide), left)
            high = low + wide
        height = 1.08 * peak(p)
        upper, lower = max(self.top, height), max(self.top, 2 * f * height)
        self.above.set_ylim(0, float(self.stress(upper)))
        self.below.set_ylim(*(sign * float(self.stress(lower)) for sign in (-1, 1)))
        self.below.set_xlim(float(self.length(low)), float(self.length(high)))

    def _shade(self, state: Any, zone: Any, dsigma: float) -> None:
        senses_of_slip = senses(zone, dsigma)
        zones = ((-state.a, -zone.m), (zone.n, state.c))
        for i, span in enumerate(self.spans):
            (start, end), sense = zones[i % 2], senses_of_slip[i % 2]
            known = bool(sense != 0) and np.isfinite(zone.m)
            span.set_visible(known)
            if known:
                span.set_x(float(self.length(start)))
                span.set_width(float(self.length(end - start)))
                span.set_color(FORWARD if sense > 0 else REVERSE)

    def _described(self, state: Any, zone: Any, loads: Loads) -> str:
        def lengths(*values: Array) -> str:
            return ", ".join(f"{float(self.length(value)):.4f}" for value in values)

        if not np.isfinite(state.a):
            return "no contact: the body cannot carry these loads"
        regime = regime_in_words(self.body, zone)
        name = self.length.name
        parts = [f"{regime}: contact [{lengths(-state.a, state.c)}] {name}"]
        parts.append(f"tilt {1e3 * float(state.alpha):.3f} mrad")
        if np.isfinite(zone.m):
            parts.append(f"stick [{lengths(-zone.m, zone.n)}] {name}")
            parts.append(f"slip {lengths(state.a - zone.m)} and {lengths(state.c - zone.n)} {name}")
        law = {"f": loads.f, **self.constants}
        threshold = self.body.tension_threshold(state, state, loads.dQ, **law).upper
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
            self.canvas.print_png(target, pil_kwargs={"compress_level": 1})  # type: ignore[no-untyped-call]
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


def _demand_start(start: Loads, largest: Loads) -> None:
    """Demand starting values between the ends of the sliders."""
    for name, value in start._asdict().items():
        most = getattr(largest, name)
        least = -most if name in ("M", "dsigma") else 0
        if np.ndim(value) or not least <= value <= most:
            raise ValueError(
                f"start.{name} is {value}, but its slider covers {least:g} to {most:g}; give a "
                f"number in this range, or increase largest.{name}"
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
    _demand_start(start, largest)
    picture = ipywidgets.Image(format="png", width=840)
    line = ipywidgets.HTML()
    scales = {"P": "N/m", "M": "N", "dQ": "N/m", "dsigma": "Pa", "f": ""}
    controls = {}
    for name, of in scales.items():
        most, value = getattr(largest, name), getattr(start, name)
        measure = unit(most, of) if of else None
        size, label = (measure.size, f"{name} [{measure.name}]") if measure else (1.0, name)
        least = {"M": -most, "dsigma": -most, "dQ": 0.0}.get(name, most / STEPS)
        controls[name] = (
            ipywidgets.FloatSlider(
                value=value / size,
                min=least / size,
                max=most / size,
                step=most / size / STEPS,
                description=label,
                readout_format=".4g",
                continuous_update=True,
                style={"description_width": "100px"},
                layout={"width": "400px"},
            ),
            size,
        )

    def follow(_: Any = None) -> None:
        line.value = live.show(
            Loads(**{name: slider.value * size for name, (slider, size) in controls.items()})
        )
        picture.value = live.png()

    for slider, _ in controls.values():
        slider.observe(follow, names="value")
    follow()
    rows = ipywidgets.HBox(
        [slider for slider, _ in controls.values()], layout={"flex_flow": "row wrap"}
    )
    return ipywidgets.VBox([rows, picture, line])
