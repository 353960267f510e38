"""What is the watch's own answer: limit cycles, sweeps over parameters, sensitivities?

In: a `Scene` and keys with values. Out: `Cycle`, `Sweep`, `Sensitivity`: many short simulations, one table. Imports `analysis`,
`results`, `simulation` and below.
"""
