"""Forces and impulses at one instant: which accelerations, and which velocities after an impact?

In: gaps' directions and rates from `contact`, masses, laws. Out: contact forces, impulses and the motion they cause, by
complementarity problems. Knows no time stepping. Imports `contact`, `candidates`, `model` and `jit`.
"""
