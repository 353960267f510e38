"""How is the governor fly of a striking train drawn?

In: its dimensions. Out: the outlines of drum and fly and the text of its scene; `governor_design` is the whole. Imports
`construction` and below.
"""
