"""Circular arc, without the parabolic approximation."""

from sympy import sqrt

from derive import Geometry, parameter, x

R = parameter("R", "radius of the arc", unit="m")
geometry = Geometry("circular_arc", g=R - sqrt(R**2 - x**2))
