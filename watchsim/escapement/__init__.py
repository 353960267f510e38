"""What does a drawn escapement do by its geometry alone: lock, draw, lift, drop, freedoms?

In: a `Scene` at its start. Out: the geometry of function (`measure`), judged by the watchmaker's `rules`, as JSON and text
(`function_report`). No forces: parts are turned by hand. Imports `analysis`, `mechanism`, `contact` and below.
"""
