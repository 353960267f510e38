"""How is a grasshopper escapement with its pendulum drawn?

In: its `grasshopper_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts;
`grasshopper_design` is the whole. Imports `construction` and below.
"""
