"""Flat punch with rounded (parabolic) edges."""

from sympy import Abs, Max

from derive import Geometry, parameter, x

b = parameter("b", "half-width of the flat", unit="m")
R = parameter("R", "radius of the rounded edges", unit="m")
geometry = Geometry("flat_rounded", g=Max(0, Abs(x) - b) ** 2 / (2 * R))
