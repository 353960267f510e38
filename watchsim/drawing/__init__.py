"""From a CAD file to closed outlines of exact lines and arcs."""
