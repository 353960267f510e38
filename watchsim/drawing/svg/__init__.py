"""Which lines, arcs and curves does an SVG file hold, and how is one written?

In: bytes or text. Out: the edges of its elements by layer, with findings about what was left out or is damaged. `svg_file` is
the door. Imports `drawing.curves`, the records of what is found, and `geometry`.
"""
