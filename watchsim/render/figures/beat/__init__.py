"""How are phase portrait, torque on the balance, forces and key instants of one beat drawn?

In: a `Trajectory`. Out: matplotlib figures. Imports `render.figures`, `analysis` and below.
"""
