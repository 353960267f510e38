"""How is a calendar star with its jumper drawn?

In: its `jumper_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts; `jumper_design` is the
whole. Imports `construction` and below.
"""
