"""What did the user declare: bodies, forces, contacts, what to keep of a run?

In: what `scene.file` read, or Python. Out: frozen records in SI units with the names people gave. `scene` holds the whole.
Imports `drawing`, `geometry` and `units`; knows nothing of the model that kernels read, but for the names of the laws.
"""
