"""What is kept of a run, and under which names?

In: rows and events that the loop writes into buffers. Out: a `Trajectory`, saved states, sums over what is not kept, and
the verdict on overlaps. Imports `simulation.loop_state`, `simulation.event_kinds`, `mechanism` and below.
"""
