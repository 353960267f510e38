"""How is a pair of involute gears drawn?

In: its `dimensions`. Out: the outline of each `gear`, `scene_text`, or `conflicts`; `design` is the whole. Imports
`construction` and below.
"""
