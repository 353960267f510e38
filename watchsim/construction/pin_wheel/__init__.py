"""How is a pin-wheel (Amant, Lepaute) escapement with its pendulum drawn?

In: its `pin_wheel_dimensions`. Out: the outlines of its parts and `pin_wheel_scene`, or conflicts; `pin_wheel_design` is the
whole. Imports `construction` and below.
"""
