"""How is a Geneva drive drawn?

In: its `geneva_dimensions`. Out: outlines of driver and wheel, the text of its scene, or conflicts; `geneva_design` is the
whole. Imports `construction` and below.
"""
