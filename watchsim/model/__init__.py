"""What do the kernels read?

In: numbers. Out: flat, read-only arrays in SI units, and the structs by which kernels get them; and how a class of named
fields becomes a record that kernels write (`named_fields`). Imports `jit` only.
"""
