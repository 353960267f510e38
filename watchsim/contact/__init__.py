"""Narrow phase: how open is a contact, how fast does it close, and along which directions do forces act?

In: a model, coordinates and velocities. Out: gaps, their rates, force directions and accelerations at rest forces; no forces.
Imports `mechanism`, `model` and `jit`; kernels import kernels only.
"""
