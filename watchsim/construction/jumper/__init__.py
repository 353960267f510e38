"""How is a calendar star with its jumper drawn?

In: its `dimensions`. Out: the outlines of its parts and `scene_text`, or conflicts; `design` is the whole. Imports
`construction` and below.
"""
