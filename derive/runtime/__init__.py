"""What generated modules need besides NumPy: an ordinary library, copied beside them as it is.

types       what functions return
arrays      how a formula serves everything that broadcasts
chunks      the same for Dask arrays
edge/       an edge without its geometry
elementary  small functions that formulas call
segments    functions of the parts of a contact that pieces of a polynomial body cover
shared      functions that serve arrays, and kernels once numba compiles them
body        one body: its law, its parameters, its functions of a cycle
cycle       what these functions take and return; they load the kernels when they are needed
reasons     what a regime means, and why a cycle has none
words       what their docstrings say of one body

Kernels, each of one case, in plain Python with `math`, compiled by numba:

kernels     what numba is asked for, and what happens without it
pieces      what a contact carries, by quadrature of g''
forward     the same for many contacts
inverse     the contact from loads
history/    any load history, on elements
slip/       stick zones, slip zones, shear, a march through a cycle
"""
