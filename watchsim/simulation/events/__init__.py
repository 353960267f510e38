"""When does the next event happen, and what follows it?

In: a smooth step. Out: the time of impact of the first open contact (`time_of_impact`), and the state and modes after the event
(`after_event`). Imports `simulation.motion` and below.
"""
