"""From proven formulas to NumPy, and in closed form to other languages.

plan      which way each function takes: formula, sum over parts, quadrature, solved
program   named steps, then outputs: what a function computes, before it is text
rewrite   rules that keep digits in floating point; the result is compared with its source
parts     formulas of kinked polynomial bodies as sums over the parts of a contact
printer   SymPy -> NumPy source
contract  which functions a module has
function  the text of one function that has a formula
summed    the same for a sum over parts, and of what all such functions hold
third     the third coefficient of the pressure next to the edges
law       the text of what the solvers need of a body
cuts      where a body without closed formulas is cut for quadrature
integrals what such a body evaluates, as its docstrings print it
curve     the text of such a body: its curve, and the functions that are integrated over it
module    the one template of a generated module
languages the closed formulas in C, Fortran, JavaScript, Julia or MATLAB
mark      what every generated file begins with
trial     runs the module as it was printed, and compares
publish   compares a whole package with what is on disk, or replaces it

What generated modules need besides NumPy is derive/runtime/, copied beside them.
"""
