"""Turns proven formulas into NumPy code, and closed formulas into code for other languages.

plan      chooses how each function is evaluated: formula, quadrature or solver
program   the steps and outputs of a function, before they are printed as text
rewrite   closed formulas for floating point: sums over parts of a contact, or rules
printer   SymPy -> NumPy source
contract  the functions that every module has
function  the text of one function that has a formula
example   numbers for the examples in docstrings
common    what functions that are sums over parts share, which then stands in one place
law       the text of the body's functions that the solvers call
cuts      the points at which a body without closed formulas is cut for quadrature
integrals the integrals that are evaluated for such a body, as its docstrings print them
curve     the text of such a body: its curve and the functions that integrate over it
module    the template of a generated module
solved    the text of the functions that are solved numerically, from solved.txt
languages the closed formulas in C, Fortran, JavaScript, Julia or MATLAB
trial     runs the printed module and compares its results with the sheet
publish   the files of a whole package, and how they differ from those on disk

Besides NumPy, generated modules need only generated/runtime/, which is copied beside them.
"""
