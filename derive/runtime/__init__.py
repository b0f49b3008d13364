"""What generated modules need besides NumPy: a library copied next to them unchanged.

types       return types of the functions
arrays      evaluation of a formula on arguments that broadcast
chunks      the same for Dask arrays
edge/       an edge given by its coefficients, without the geometry of the body
elementary  small functions that formulas call
segments    functions of the parts of a contact, each on one piece of a polynomial body
shared      functions of arrays that kernels can also call, compiled by numba
body        one body: its law, its parameters, its functions of a cycle
cycle       the public functions of a cycle; they load the kernels on first use
reasons     the meaning of a regime, and why a cycle has none
words       words and examples for the docstrings of one body, and for waiting users

Kernels, each written for one case, in plain Python with `math`, compiled by numba:

kernels     the decorators for numba, and their substitutes without it
pieces      load, moment, tilt, pressure and edge coefficients, by quadrature of g''
search      the root of an increasing function
inverse     the contact under given loads
forward     contacts and their state, case by case
history/    any load history, on elements
slip/       stick zones, slip zones, shear, a march through a cycle
"""
