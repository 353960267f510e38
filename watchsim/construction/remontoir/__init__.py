"""How is a remontoir before a Swiss lever drawn?

In: its dimensions, those of the lever and its own. Out: the outlines of its parts and the text of its scene, or conflicts;
`remontoir_design` is the whole. Imports `construction` and below.
"""
