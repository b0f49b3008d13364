"""Wedge on the left, parabola on the right."""

from sympy import Piecewise

from derive import Geometry, parameter, x

phi = parameter("phi", "slope of the left flank", unit="rad")
R = parameter("R", "relative radius of curvature on the right", unit="m")
geometry = Geometry("wedge_parabola", g=Piecewise((-phi * x, x < 0), (x**2 / (2 * R), True)))
