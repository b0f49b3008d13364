"""Proof: every formula of a sheet against a route that does not share its derivation.

verdict     what is known of a formula, and how two numbers are compared
balls       numbers that know how far rounding may have moved them
rule        quadrature that cuts finer until its estimate of error is small
points      random states drawn from a formula's assumptions
quadrature  the defining integrals of g(x), by quadrature
symbolic    routes that end in an exact zero
numerical   routes that end in 30 digits or more at 24 points
prove       sheet -> the same sheet with a proof for every formula
"""
