"""Broad phase: which pairs of primitives could touch while two bodies stay near a place in their configuration space?

In: a model. Out: for each cell of the coordinates of two bodies the contacts that could close in it; never too few.
`broad_phase` asks shapely, once for a cell; compiled code looks the answer up by `cell_lookup`. Imports `model` and `jit`.
"""
