"""Cylinder on a half-plane (Hertz)."""

from derive import Geometry, parameter, x

R = parameter("R", "relative radius of curvature", unit="m")
geometry = Geometry("hertz", g=x**2 / (2 * R))
