"""What does a run leave on disk, and how is it read back?

In: a `Trajectory` with its numbers. Out: the results folder (`write_results`: summary.json, trajectory.npz, events.csv and the
rest) and what comes back from it (`read_results`). Imports `simulation`, `scene` and `storage`.
"""
