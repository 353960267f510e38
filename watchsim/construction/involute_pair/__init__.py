"""How is a pair of involute gears drawn?

In: its `involute_pair_dimensions`. Out: the outline of each gear, the text of its scene, or conflicts; `involute_pair_design`
is the whole. Imports `construction` and below.
"""
