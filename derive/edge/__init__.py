"""From a finite-element table to slip zones: what `derive edge` does.

table   a file as programs export it -> load steps, in SI units
find    load steps -> coefficients, moves and slip zones of both edges, with their uncertainty
report  the same as text, as CSV, as a page

The mathematics is the runtime's: derive/runtime/edge.
"""
