"""How is a ratchet wheel with its click drawn?

In: its `ratchet_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts; `ratchet_design` is the
whole. Imports `construction` and below.
"""
