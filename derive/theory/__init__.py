"""The mechanics of one half-plane contact, stage by stage; each module imports only earlier ones.

frame        the contribution of a kink: its angle, its root, its logarithm
algebra      a common form for formulas, and a proof that one is zero
moments      I_k(a, c), the integrals from which equilibrium follows
equilibrium  tilt from I_0 = 0, load and moment from I_1 and I_2
pressure     p(x) inside the contact
contact_law  inverses of the contact law: (P, M) -> (a, c, alpha) and (P, alpha) -> (a, c, M)
edges        the series of p at an edge, whose first coefficients are K_N and L_N
segments     functions of the angle that a part of a contact spans
parts        formulas of piecewise polynomial bodies as sums over the parts of a contact
superposition  P, M, p, K_N and L_N as integrals of g'', for a body of any profile
special      terms of g' whose integrals are special functions: one rule for each kind of term
closed_forms  closed forms from these rules and from the polynomial terms of g'
stick        full stick and its edge coefficients, the stick margin, and the stick zone
slip         slip zones as series in the changes in the loads, to any order
"""
