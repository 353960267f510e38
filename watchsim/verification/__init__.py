"""Do the closed-form and published benchmarks come out?

In: nothing but the package. Out: rows of computed against exact. `all_checks` is the door; `closed_forms` and `closed_swings`
share no code with the solver. Imports `simulation` and all below.
"""
