"""An edge given by its coefficients, without the body's geometry; published as generated/edge.py.

zone     the slip zone from coefficients: of a single edge, with the width, or with the other edge
near     tractions, slip and work of friction next to an edge
fit      coefficients from nodal pressures, from full-stick shear, from reaction forces
elastic  the composite modulus
rig      loads of a body whose edge then matches the edge of another contact
both     both edges by the conditions of ../slip/series.py, compiled
"""

from .elastic import E_star, EdgeWarning, dundurs
from .fit import K_N_from_loads, PressureFit, ShearFit, fit_pressure, fit_stuck_shear
from .near import Peak, Tractions, peak, reach, slip_range, tractions, work
from .rig import Edge, Rig, describe, match
from .zone import OtherEdge, Pressure, SlipZone, slip_zone

__all__ = [
    "E_star",
    "Edge",
    "EdgeWarning",
    "K_N_from_loads",
    "OtherEdge",
    "Peak",
    "Pressure",
    "PressureFit",
    "Rig",
    "ShearFit",
    "SlipZone",
    "Tractions",
    "describe",
    "dundurs",
    "fit_pressure",
    "fit_stuck_shear",
    "match",
    "peak",
    "reach",
    "slip_range",
    "slip_zone",
    "tractions",
    "work",
]
