"""Where does a mechanism settle?

In: a `Scene`. Out: its limit cycle with errors and stability, or what there is instead (`find_cycle`), from its return map.
Imports `analysis`, `simulation` and below.
"""
