"""How does the watch beat: amplitude, rate, beat error, phases of a beat, and does it still tick?

In: a `Trajectory`. Out: beats and the numbers a timegrapher would show. Imports `simulation.record`, `scene` and below.
"""
