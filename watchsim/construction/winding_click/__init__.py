"""How is a winding click with recoil drawn?

In: its `winding_click_dimensions`. Out: the outlines of its parts and the text of its scene, or conflicts;
`winding_click_design` is the whole. The wheel is that of `construction.ratchet`. Imports `construction` and below.
"""
