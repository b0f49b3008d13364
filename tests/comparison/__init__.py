"""Comparison of the package with the independent solver, cycle by cycle.

cases   the cycles: the result cases of the paper, and others
table   solver, exact conditions and series for each of them, as a table
around  the same for the upright wedge with tensions around its threshold

`python -m tests.comparison` writes both tables to notebooks/comparison.md.
"""
