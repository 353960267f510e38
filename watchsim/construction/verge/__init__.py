"""How is a verge escapement with its foliot drawn?

In: its `dimensions`. Out: the outlines of its parts and `scene_text`, or conflicts; `design` is the whole. Imports
`construction` and below.
"""
