"""Flat punch with sloped sides: a truncated wedge."""

from sympy import Abs, Max

from derive import Geometry, parameter, x

b = parameter("b", "half-width of the flat", unit="m")
phi = parameter("phi", "slope of the sides", unit="rad")
geometry = Geometry("flat_sloped", g=phi * Max(0, Abs(x) - b))
