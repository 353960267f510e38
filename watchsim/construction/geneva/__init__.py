"""How is a Geneva drive drawn?

In: its `dimensions`. Out: outlines of driver and wheel, `scene_text`, or `conflicts`; `design` is the whole. Imports
`construction` and below.
"""
