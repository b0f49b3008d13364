"""Power law, k > 1: infinite curvature at the apex for k < 2, a parabola at k = 2."""

from sympy import Abs

from derive import Geometry, parameter, x

k = parameter("k", "exponent, greater than one", unit="-")
L = parameter("L", "distance from the apex at which the flanks have slope one", unit="m")
geometry = Geometry("power", g=Abs(x) ** k / (k * L ** (k - 1)))
