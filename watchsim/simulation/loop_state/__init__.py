"""What does the event loop read and write: its state, its room to work in, the buffers of what is kept?

In: a model. Out: arrays and records made once for a run; kernels get the parts that they may touch. Imports `dynamics`,
`contact` and `model`.
"""
