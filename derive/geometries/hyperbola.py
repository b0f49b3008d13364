"""Hyperbola: a wedge far from its apex, a parabola of radius b/phi close to it."""

from sympy import sqrt

from derive import Geometry, parameter, x

phi = parameter("phi", "slope of the flanks far from the apex", unit="rad")
b = parameter("b", "length scale over which the flanks bend", unit="m")
geometry = Geometry("hyperbola", g=phi * sqrt(x**2 + b**2))
