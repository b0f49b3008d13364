"""Compute slip zones from a finite-element table, for the command `derive edge`.

table   reads an exported file and returns its load steps in SI units
find    computes coefficients, movements and slip zones of both edges, with their uncertainties
report  writes the results as text, as CSV, or as an HTML page

The mathematics is in derive/runtime/edge.
"""
