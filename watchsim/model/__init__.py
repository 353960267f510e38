"""What do the kernels read?

In: numbers. Out: flat, read-only arrays in SI units, and the structs by which kernels get them. Imports `jit` only.
"""
