"""A body: its profile g(x), where it is convex, and the library of geometry files.

module       contents
----------   ------------------------------------------------------------------
piece        one piece of a profile, and the jump of g' where two pieces meet
steep        simplification of functions of very different steepness
lows         a search for places where a curvature may be negative
trial        a test of many parameters, with numbers
convexity    the conditions under which g'' >= 0
branches     Abs, Max, Min, sign and Piecewise as cases of a condition
profile      the pieces of g(x), and the contribution of each kink
geometry     Geometry and parameter, the names that a geometry file needs
library      the geometry files of the library, and those of users
"""
