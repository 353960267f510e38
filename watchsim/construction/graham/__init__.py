"""How is Graham's dead-beat escapement with its pendulum drawn?

In: its `dimensions`. Out: outlines of wheel and anchor, `scene_text`, or `conflicts`; `design` is the whole. The recoil anchor
is drawn by the same files. Imports `construction` and below.
"""
