"""How fast and how exact are this solver, its twin and other engines on the same scenes?

In: scenarios. Out: error and time for each setting of each engine, in tables. `compare` is the door. Imports `verification`,
`analysis` and all below.
"""
