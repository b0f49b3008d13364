"""Pictures of contacts and of their cycles, drawn with matplotlib.

    module      content
    ---------   --------------------------------------------------------------------
    style       the style of all pictures, applied in a context
    measure     the units of axes: a symbol and its unit, or a ratio
    given       checks of the input, which raise one clear error
    tractions   pressure; shear traction and its change over a half-cycle; slip, frictional work
    zones       maps of stick and slip over a cycle, over any history, or against a parameter
    histories   any load history: shear, slip, frictional work, animation
    live        contact, tractions and slip zones of a cycle, controlled by sliders in a notebook
    series      errors of the series of the slip zones, against the size of the zones

A generated module and its constants are passed as arguments, for example
``pressures(wedge, states, ...)``; this package does not load any body itself.  Every function draws
into the Axes that are passed in, or into new ones, and returns them.
"""

from importlib.util import find_spec

from derive.command.errors import MissingLibrary

if find_spec("matplotlib") is None:
    raise MissingLibrary("matplotlib", "drawing", "plot")

from derive.plot.histories import film, friction_work, instants, work
from derive.plot.live import Loads, sliders
from derive.plot.measure import Measure, unit
from derive.plot.series import errors, relative_errors
from derive.plot.style import COLOURS, LINES, save, style, subplots
from derive.plot.tractions import pressures, shear, slip, tractions
from derive.plot.zones import boundaries, key, slip_map, stick_slip, sweep

__all__ = [
    "COLOURS",
    "LINES",
    "Loads",
    "Measure",
    "boundaries",
    "errors",
    "film",
    "friction_work",
    "instants",
    "key",
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
