"""Quartic: flatter at its apex than any parabola."""

from derive import Geometry, parameter, x

L = parameter("L", "distance from the apex at which the flanks have slope one", unit="m")
geometry = Geometry("quartic", g=x**4 / (4 * L**3))
