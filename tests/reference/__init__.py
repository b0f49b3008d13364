"""An independent reference: frictional contact of two similar half-planes by boundary elements.

Nothing of `derive` or `generated` is imported here.  One way, from top to bottom:

    mesh.py         nodes clustered at the places where tractions have roots
    kernel.py       displacement at the nodes by tractions that are linear between them
    bounded.py      the one problem solved: tractions between bounds, and what moves against them
    loads.py        P, M, Q, sigma of one state; the straight line between two states
    normal.py       p from g(x), P and M
    friction.py     q through load steps with Coulomb friction, cycle after cycle until it settles
    stick.py        the permanent stick zone, located within the elements
    solver.py       all of it on finer and finer meshes, with an estimate of the error
    conditions.py   the exact stick zone: two integral conditions, and the premise they stand on
    mixed.py        the exact stick zone where slip turns round inside the half-cycle
    cases.py        cycles whose stick zone is known
    explore.py      cycles around the threshold, and with varying moment
    report.py       what came out, as Markdown
    __main__.py     the command that writes FINDINGS.md

Signs: q is the traction on the body whose bulk tension counts positive, x to the right; slip is
its displacement relative to the other one.
"""
