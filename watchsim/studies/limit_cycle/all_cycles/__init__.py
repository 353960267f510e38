"""Which cycles does a mechanism have, stable or not, and which swings lead to which?

In: a return map. Out: its fixed points over all amplitudes, in a table. Imports `studies.limit_cycle` and below.
"""
