"""Cylinder whose radius changes at its lowest point."""

from sympy import Piecewise

from derive import Geometry, parameter, x

R_1 = parameter("R_1", "relative radius of curvature on the left", unit="m")
R_2 = parameter("R_2", "relative radius of curvature on the right", unit="m")
geometry = Geometry("two_radii", g=Piecewise((x**2 / (2 * R_1), x < 0), (x**2 / (2 * R_2), True)))
