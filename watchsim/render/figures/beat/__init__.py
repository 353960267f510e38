"""Plots of one beat: phase portrait, torque on the balance, forces, the mechanism at key instants."""
