"""What does a mechanism do when it is turned step by step, without forces?

In: a `Scene`. Out: what meets what at which angle, and how closely parts pass (`turn`), as text and JSON (`report`). Imports
`mechanism`, `contact` and `candidates`; shares nothing with the solver but lines and arcs.
"""
