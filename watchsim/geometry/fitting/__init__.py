"""Which few arcs follow a curve within a tolerance?

In: curves given by points and derivatives, a tolerance in their unit. Out: chains of lines and arcs, tangent where curves are.
`fit` is the door. Imports the primitives of `geometry` only.
"""
