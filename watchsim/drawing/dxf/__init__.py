"""Which lines, arcs and curves does a DXF file hold, and how is one written?

In: bytes. Out: the edges of its entities by layer, with findings about what was left out or looks damaged. `dxf_file` is the
door. Imports `drawing.curves`, the records of what is found, and `geometry`.
"""
