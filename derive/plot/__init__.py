"""Pictures of contacts and of their cycles, by matplotlib.

    module      draws
    ---------   --------------------------------------------------------------------
    style       the look that all pictures share, applied in a context
    measure     what stands on an axis: a symbol and its unit, or a ratio
    given       what cannot be drawn, refused with one clear error
    tractions   pressure; shear, and its change over a half-cycle; slip and the friction's work
    zones       stick and slip over a cycle, or over a parameter
    histories   any load history: stick and slip over time, shear, slip, friction's work, a film
    live        the same under sliders, in a notebook
    series      how far the series of the slip zones are off, against their size

A generated module and its constants are passed in, as in ``pressures(wedge, states, ...)``; this
package reads no body itself.  Every function draws into the Axes that it is given, or into new
ones, and returns them.
"""

from importlib.util import find_spec

from derive.errors import MissingLibrary

if find_spec("matplotlib") is None:
    raise MissingLibrary("matplotlib", "drawing", "plot")

from derive.plot.histories import film, friction_work, instants, slip_map, work
from derive.plot.live import Live, Loads, sliders
from derive.plot.measure import Measure, over, unit
from derive.plot.series import errors, relative_errors
from derive.plot.style import COLOURS, LINES, save, style, subplots
from derive.plot.tractions import pressures, shear, slip, tractions
from derive.plot.zones import boundaries, key, stick_slip, sweep

__all__ = [
    "COLOURS",
    "LINES",
    "Live",
    "Loads",
    "Measure",
    "boundaries",
    "errors",
    "film",
    "friction_work",
    "instants",
    "key",
    "over",
    "pressures",
    "relative_errors",
    "save",
    "shear",
    "sliders",
    "slip",
    "slip_map",
    "stick_slip",
    "style",
    "subplots",
    "sweep",
    "tractions",
    "unit",
    "work",
]
