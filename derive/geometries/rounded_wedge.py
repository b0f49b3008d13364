"""Wedge with a rounded (parabolic) apex."""

from sympy import Abs, Piecewise

from derive import Geometry, parameter, x

phi = parameter("phi", "slope of the flanks", unit="rad")
b = parameter("b", "half-width of the rounded apex", unit="m")
geometry = Geometry(
    "rounded_wedge",
    g=Piecewise((phi * x**2 / (2 * b), Abs(x) < b), (phi * (Abs(x) - b / 2), True)),
)
