"""From a CAD file to closed outlines of exact lines and arcs: what does the file hold, and what is wrong with it?

In: the bytes of a DXF or SVG file, or of a solid. Out: a `Drawing` with its loops and findings; no file makes it raise. `read`
is the door. A file passes `dxf`, `svg` or `sections`, then `curves` or `facets`, then `chaining`. Imports `geometry`, `units`.
"""
