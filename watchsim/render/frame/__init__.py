"""What does one frame of a movie show, and where does everything in it stand?

In: a `Trajectory` and a time. Out: a drawn frame; any frame can be drawn alone. `stage` is the door. Imports the palette of
`render`, `simulation.record`, `scene` and below.
"""
