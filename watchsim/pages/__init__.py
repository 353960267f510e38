"""How is a run shown in one HTML file that opens anywhere: player, linked plots, timing sheet?

In: a `Trajectory` and its numbers. Out: the text of the page (`report` writes it). Imports `render`, `analysis`, `results` and
below; loads nothing from a network.
"""
