"""Proof: every formula of a sheet is compared with a route independent of its derivation.

verdict     the result of a proof, and how many digits two numbers share
balls       numbers with a bound on their error, and functions of them
rule        one rule of quadrature with one check of it
kinks       where an expression may kink, jump, peak or diverge
values      an expression -> its value in digits that are certain, with integrals
points      random states that meet a formula's assumptions
quadrature  the defining integrals of g(x), by quadrature
symbolic    routes that end in an exact zero
numerical   routes that end in agreement to 30 digits or more at 24 points
prove       a sheet -> the same sheet with a proof for every formula

derive.check takes the values of both sides of a claim from here, too.
"""
