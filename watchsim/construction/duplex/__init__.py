"""How is a duplex escapement drawn?

In: its `duplex_dimensions`. Out: the outlines of its parts and `duplex_scene`, or conflicts; `duplex_design` is the whole.
Imports `construction` and below.
"""
