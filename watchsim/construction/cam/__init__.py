"""How is an eccentric cam with its follower drawn?

In: its `dimensions`. Out: the outlines of its parts and `scene_text`, or conflicts; `design` is the whole. Imports
`construction` and below.
"""
