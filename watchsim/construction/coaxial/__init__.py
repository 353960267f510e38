"""How is a co-axial escapement drawn?

In: its `coaxial_dimensions`. Out: its sheets and the text of its scene, or conflicts; `coaxial_design` is the whole. Imports
`construction` and below.
"""
