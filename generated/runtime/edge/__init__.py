"""An edge given by its coefficients, without the body's geometry; published as generated/edge.py.

near     slip zone, tractions and slip next to an edge
fit      coefficients from nodal pressures, from full-stick shear, from reaction forces
average  the average over all fits to an edge
elastic  the composite modulus
rig      loads of a body whose edge then matches the edge of another contact
"""

from .elastic import E_star, EdgeWarning, dundurs
from .fit import K_N_from_loads, PressureFit, ShearFit, fit_pressure, fit_stuck_shear
from .near import Edge, SlipZone, Tractions, reach, slip_range, slip_zone, tractions
from .rig import Rig, describe, match

__all__ = ["E_star", "EdgeWarning", "K_N_from_loads", "PressureFit", "ShearFit", "dundurs"]
__all__ += ["Edge", "SlipZone", "Tractions", "fit_pressure", "fit_stuck_shear", "reach"]
__all__ += ["Rig", "describe", "match", "slip_range", "slip_zone", "tractions"]
