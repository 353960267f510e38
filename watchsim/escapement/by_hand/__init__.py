"""Where does a wheel rest while the lever is led by hand?

In: a compiled scene. Out: which parts are wheel, lever and balance (`parts`), where they touch as they are turned (`hands`, by
the kernels of `turning`), and what the wheel does from one angle of the lever to another (`sweep`). Imports `mechanism`,
`contact` and below.
"""
