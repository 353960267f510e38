"""How does a scene become a model, and what can be said of it before anything is simulated?

In: a `Scene`. Out: the `Model` that kernels read, with the names of its rows; overlaps, notes and counts for people.
`compile` is the door. Imports `candidates`, `model`, `scene`, `drawing` and `geometry`.
"""
