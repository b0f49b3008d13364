"""Parabola plus quartic: a cylinder whose flanks steepen."""

from derive import Geometry, parameter, x

R = parameter("R", "relative radius of curvature at the apex", unit="m")
L = parameter("L", "distance from the apex at which the quartic term alone has slope one", unit="m")
geometry = Geometry("parabola_quartic", g=x**2 / (2 * R) + x**4 / (4 * L**3))
