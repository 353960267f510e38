"""What follows an event?

In: the state at the end of a step, and the contact that has closed if one has. Out: the state and the modes after the event
(`after_event`). Imports `simulation.motion` and below.
"""
