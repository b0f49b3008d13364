"""Shallow wedge on a half-plane; its apex half-angle is pi/2 - phi."""

from sympy import Abs

from derive import Geometry, parameter, x

phi = parameter("phi", "slope of the flanks", unit="rad")
geometry = Geometry("wedge", g=phi * Abs(x))
