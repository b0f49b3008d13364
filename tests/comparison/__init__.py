"""What the package says of a cycle beside what the independent solver finds.

cases   the paper's result cases and some of our own
table   solver, exact conditions, and series, as one table: `python -m tests.comparison`
"""
