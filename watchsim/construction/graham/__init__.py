"""How is Graham's dead-beat escapement with its pendulum drawn?

In: its `graham_dimensions`. Out: outlines of wheel and anchor, the text of its scene, or conflicts; `graham_design` is the
whole. The recoil anchor is drawn by the same files. Imports `construction` and below.
"""
