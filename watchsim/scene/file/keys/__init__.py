"""Which keys may a scene file hold, on which line do they stand, and which number in SI does a value mean?

In: tables of TOML. Out: SI values, names and faults; `key_values` turns texts such as "12 mg·cm²" into numbers.
Imports `units` and the errors of `scene`.
"""
