"""Any load history: exact where that is known, else on elements, load step by load step.

elements    the mesh, the influence of shear on displacement, pressure and full-stick shear on it
nearest     the shear within friction that is nearest to a trial one: one convex problem a step
path        the loads and contacts on the way from instant to instant
steps       the state, its steps, and what is told of it
solve       histories and steady cycles on ever finer meshes, and the estimate of their error
reversals   moderate tension in phase at constant normal loads: exact, a stack of reversals
loops       closed loops of P and Q at a constant tilt: the exact stick zone
batch       many cases at once, on all cores
lazy        histories of Dask arrays
public      the functions that a module offers
"""
