"""Kinematics of contacts: gaps, directions and candidate pairs; no forces."""
