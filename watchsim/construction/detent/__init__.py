"""How is a detent escapement of a marine chronometer drawn?

In: its `detent_dimensions`. Out: its sheets and the text of its scene, or conflicts; `detent_design` is the whole. Imports
`construction` and below.
"""
