"""Partial slip: stick zones, slip zones and shear of a cycle, from a body's law.

quadrature  nodes and weights on a slip zone
newton      Newton's method in a bracket, and for two slip zones
bounded     slip zones next to which the shear traction stays bounded
moderate    the stick zone as a contact of the same body
large       the stick zone between slip zones of opposite signs
growth      whether slip grows throughout the half-cycle, as both of these assume
tables      functions of one variable as Chebyshev series
zone        the regime of a cycle, and its stick zone
mixed       the stick zone where slip reverses within a half-cycle
threshold   tensions at which a cycle is no longer moderate
series      slip zones by series in their length
shear       the change in shear, and the slip range
march       a cycle instant by instant
"""
