"""Points, lines, arcs: where do they lie, where do they meet, what do they enclose?

In: numbers in metres and radians. Out: primitives, closed loops, and what can be computed of them exactly in the plane.
Knows nothing of drawings or mechanisms; imports nothing of the package but its own files.
"""
