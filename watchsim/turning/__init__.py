"""Mechanisms turned step by step without forces: what meets what at which angle, and what passes by how little."""
