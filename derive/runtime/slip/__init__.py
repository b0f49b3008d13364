"""Partial slip: stick zones, slip zones and shear of a cycle, from a body's law.

quadrature  nodes and weights on a slip zone
newton      Newton's method in a bracket, and for two slip zones
bounded     slip zones beside which shear stays bounded
moderate    the stick zone as a contact of the same body
large       the stick zone between slip zones of opposite signs
growth      whether slip grows all the way, as both assume
tables      functions of one variable by Chebyshev series
zone        which of these a cycle is
mixed       the stick zone where slip reverses within a half-cycle, too
threshold   tensions at which a cycle is no longer moderate
series      slip zones by series in their length
shear       the change of shear, and how far the surfaces slip
march       a cycle instant by instant
"""
