"""How is a mechanism drawn from its dimensions?

In: dimensions with limits and sources. Out: outlines (`Sheet`) and the text of a scene; `known` lists the designs, one folder
each. Imports `drawing` and `geometry`; knows no scene.
"""
