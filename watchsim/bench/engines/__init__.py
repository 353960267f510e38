"""How does a scene run in another engine?

In: a `Scene`. Out: a world that steps it; one file for each engine. Other engines are imported only when one is asked for.
Imports `scene` and `geometry`.
"""
