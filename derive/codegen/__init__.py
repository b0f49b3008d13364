"""From proven formulas to NumPy.

program   named steps, then outputs: what a function computes, before it is text
rewrite   rules that keep digits in floating point; the result is compared with its source
printer   SymPy -> NumPy source
contract  which functions a module has
memory    how many arrays a function holds at once
function  the text of one function
cancel    where closed formulas lose digits to powers that cancel
integrated  the text of functions that are integrated, everywhere or where kinks crowd
parabolas  the text of functions that are added up part by part between kinks
third     the text of the third coefficient of the pressure next to the edges
solved    the text of the inverses that have no closed formula
module    the one template of a generated module
mark      what every generated file begins with
trial     runs the module as it was printed, and compares
publish   compares a whole package with what is on disk, or replaces it
support/  what generated modules need besides NumPy; copied beside them
"""
