"""How is an eccentric cam with its follower drawn?

In: its `cam_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts; `cam_design` is the whole.
Imports `construction` and below.
"""
