"""When does the first open contact close within a step?

In: the path of a smooth step. Out: the time of impact and its contact (`time_of_impact`), by conservative advancement: gaps are
looked at as often as bounds of their rates and accelerations ask for. Imports `simulation.events` and below.
"""
