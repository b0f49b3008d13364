"""Partial slip: stick zones, slip zones and shear of a cycle, from a body's law.

cycles      a half-cycle, its contacts and its loads
quadrature  nodes and weights on a slip zone
newton      Newton's method for two slip zones
bounded     the stick zone between slip zones that grow
growth      whether slip grows throughout the half-cycle
zone        the regime of a cycle, and its stick zone
mixed       the stick zone where slip reverses within a half-cycle
series      slip zones by series in their length
shear       the change in shear, and the slip range
"""
