"""How is a tourbillon, a Swiss lever on a carriage, drawn?

In: its dimensions, those of the lever and its own. Out: the outlines of its parts and the text of its scene, or conflicts;
`tourbillon_design` is the whole. Imports `construction` and below.
"""
