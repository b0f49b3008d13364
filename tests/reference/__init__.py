"""An independent reference: frictional contact of two similar half-planes by boundary elements.

Nothing is imported from `derive` or `generated`.  The modules, each of which uses only those above
it:

    mesh.py         nodes clustered at points near which tractions vary like a square root
    kernel.py       displacements at the nodes due to tractions that are linear between nodes
    bounded.py      the basic problem: tractions between bounds, and the motion that opposes them
    loads.py        P, M, Q and sigma of one state; the straight line between two states
    normal.py       p from g(x), P and M
    friction.py     q in load steps with Coulomb friction, cycle by cycle until it is steady
    stick.py        the permanent stick zone, located within the elements
    solver.py       the stick zone on successively finer meshes, with an estimate of the error
    conditions.py   the exact stick zone: two integral conditions, and the premise of these
    mixed.py        the exact stick zone if slip reverses within the half-cycle
    cases.py        cycles whose stick zone is known

Signs: q is the shear traction on the body whose bulk tension counts as positive, x points to the
right, and slip is the displacement of this body relative to the other one.
"""
