"""How is a wheel with cycloidal teeth drawn with its pinion?

In: its `cycloidal_pair_dimensions`. Out: the outline of each, the text of its scene, or conflicts; `cycloidal_pair_design`
is the whole. Imports `construction` and below.
"""
