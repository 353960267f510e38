"""How is a Geneva stop-work drawn?

In: its `geneva_stop_dimensions`. Out: the outlines of its parts and `geneva_stop_scene`, or conflicts; `geneva_stop_design`
is the whole. Most of it is a `geneva` drive. Imports `construction` and below.
"""
