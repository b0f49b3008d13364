"""The library that every generated package needs, besides NumPy.

It is written by hand: change it like any other code, here and nowhere else.  `derive generate --out
DIR` copies it into other packages.  Its version is raised when a name, an argument or the form of a
result changes.

From a call to a result:

types       what functions return; the codes of regimes
arrays      checks and broadcasts arguments, evaluates formulas, fills tables case by case
chunks      the same for Dask arrays
cycle       what the functions of a body call that are solved, from contacts to a march
reasons     the meaning of a regime, and why a cycle has none
history/    any load history
edge/       an edge given by its coefficients, without the geometry of the body

Kernels, each written for one case, in plain Python with `math`, compiled by numba:

kernels     the decorators, and what they become without numba; a body as the kernels see it
elementary  small functions that printed formulas call
segments    functions of the parts of a contact, each on one piece of a polynomial body
pieces      load, moment, tilt, pressure and edge coefficients, by quadrature of g''
search      the root of an increasing function
inverse     the contact under given loads
forward     contacts and their state, case by case
slip/       stick zones, slip zones, shear, a march through a cycle
"""

VERSION = 2
