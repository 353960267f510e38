"""Which lines and arcs stand for the splines, ellipses and tilted shapes of a drawing?

In: shapes in the plane or in space, as a reader of a format found them. Out: lines and arcs within the fit tolerance.
`curves_to_arcs` is the door. Imports `geometry`, `geometry.fitting` and the records of `drawing`.
"""
