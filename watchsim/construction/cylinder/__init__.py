"""How is a cylinder escapement drawn?

In: its `cylinder_dimensions`. Out: the outlines of its parts and `cylinder_scene`, or conflicts; `cylinder_design` is the
whole. Imports `construction` and below.
"""
