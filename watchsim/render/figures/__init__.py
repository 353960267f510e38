"""Plots: what changes over time, over a beat or over a parameter."""
