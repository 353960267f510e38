"""Which edges of a drawing form closed outlines, which of them are holes, and what keeps the others open?

In: edges with the entity they came from. Out: sound loops, and findings with coordinates. `chain` is the door.
Imports `geometry` and the records of `drawing`.
"""
