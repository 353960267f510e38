"""How is one picture drawn: a drawing, a scene at its start, a mechanism turned by hand, the geometry of function?

In: a `Drawing`, a `Scene` or what was measured of it. Out: PNG, SVG or PDF. Imports `render.frame`, `escapement`, `turning` and
below.
"""
