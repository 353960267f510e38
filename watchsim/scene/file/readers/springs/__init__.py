"""What may a spring be given by besides its stiffness?

In: the table of a spring. Out: how it is drawn, the stiffness of a leaf, its rest and its stop. Imports what `readers` does.
"""
