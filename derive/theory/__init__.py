"""The mechanics of one half-plane contact, stage by stage; each module imports only earlier ones.

frame        what a kink brings: its angle, its root, its logarithm
ring         expressions as polynomials over the rationals, in FLINT
algebra      one form for each formula, and an exact answer to "is it zero"
moments      I_k(a, c), the integrals that equilibrium is made of
equilibrium  tilt from I_0 = 0, load and moment from I_1 and I_2
pressure     p(x) inside the contact
contact_law  P'(c) along fixed tilt, F(c), and the inverses (P, M), (P, alpha) -> (a, c)
edges        K_N by two routes, the series of p at an edge
segments     the same of polynomials between kinks, as sums over the parts of a contact
superposition  P, M, p, K_N and L_N as integrals of g'', of a body of any shape
special      terms of g' whose integrals are special functions: one rule a kind of term
closed_forms  what those rules and the polynomials of g' make together
stick        full stick and its edges, what keeps an edge from slipping, the stick zone
slip         slip zones by series in their length, to any order
edge         slip and shear next to an edge alone, from its coefficients
"""
