"""Points, lines, arcs: exact planar geometry that knows nothing of mechanisms."""
