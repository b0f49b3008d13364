"""Catenary (hyperbolic cosine): a cylinder whose flanks steepen without limit."""

from sympy import cosh

from derive import Geometry, parameter, x

R = parameter("R", "relative radius of curvature at the apex", unit="m")
b = parameter("b", "length scale over which the flanks steepen", unit="m")
geometry = Geometry("catenary", g=b**2 / R * (cosh(x / b) - 1))
