"""How is the snail of a striking train with its rack drawn?

In: its `snail_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts; `snail_design` is the whole.
Imports `construction` and below.
"""
