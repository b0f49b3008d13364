"""Proof: every formula of a sheet is compared with a route independent of its derivation.

verdict     the result of a proof, and the comparison of two numbers
balls       numbers with a bound on their rounding error
rule        quadrature that refines its intervals until the estimated error is small
points      random states that meet a formula's assumptions
quadrature  the defining integrals of g(x), by quadrature
symbolic    routes that end in an exact zero
numerical   routes that end in agreement to 30 digits or more at 24 points
prove       a sheet -> the same sheet with a proof for every formula
"""
