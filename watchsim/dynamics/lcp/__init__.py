"""Which x solves y = A x + b, y >= 0, x >= 0, y.x = 0?

In: A and b. Out: x, or that none was found. Lemke's method (`lemke_pivoting`), units (`scaling`), and the check of a basis
(`basis`). Knows no mechanics; imports `jit` only.
"""
