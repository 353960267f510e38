"""What do several commands need: the terminal, the requested scene, a place to write, the writing of a run?

In: parsed arguments. Out: scenes, places, words on the terminal. Imports everything below `commands`, when called.
"""
