"""How is a Swiss lever escapement drawn?

In: its `dimensions`. Out: `sheets` and `scene_text`, or `conflicts`; `design` is the whole. Imports `construction` and below.
"""
