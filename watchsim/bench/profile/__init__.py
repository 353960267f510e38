"""Where does the time of a run go, and how far is it from the least that its kernels take?

In: a finished run. Out: shares of its time by kind of work. `run_profile` is the door. Imports `simulation` and all below.
"""
