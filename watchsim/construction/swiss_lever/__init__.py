"""How is a Swiss lever escapement drawn?

In: its `swiss_lever_dimensions`. Out: its sheets and the text of its scene, or conflicts; `swiss_lever_design` is the whole.
Imports `construction` and below.
"""
