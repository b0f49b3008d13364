"""Load histories of any kind: exact where a solution is known, otherwise on elements in load steps.

elements    the mesh, its influence matrix, and the pressure and the full-stick shear on it
nearest     the shear within the friction limits that is nearest to a trial: a convex problem
path        the loads and contacts from one instant to the next
steps       the state of the elements, and one load step
zones       stick zones on elements: that of a load step, and the permanent one of a cycle
refine      histories and steady cycles on successively finer meshes, with an estimate of the error
reversals   moderate tension in phase at constant normal loads: exact, a stack of reversals
march       cycles in phase instant by instant, from the exact stick zones
loops       closed loops of P and Q at a constant tilt: the exact stick zone
public      the functions that a generated module calls
"""
