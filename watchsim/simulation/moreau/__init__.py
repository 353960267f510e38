"""Moreau's time stepping on the same model: does a method that shares no event with the other come to the same motion?

In: a scene, a step. Out: a `Trajectory`. `time_stepping` is the door, `steps` the loop. Imports `simulation.runner` and
what the kernels of one step need from `simulation.events`, `simulation.motion` and below.
"""
