"""Wedge with unequal flanks."""

from sympy import Piecewise

from derive import Geometry, parameter, x

phi_1 = parameter("phi_1", "slope of the left flank", unit="rad")
phi_2 = parameter("phi_2", "slope of the right flank", unit="rad")
geometry = Geometry("unequal_wedge", g=Piecewise((-phi_1 * x, x < 0), (phi_2 * x, True)))
