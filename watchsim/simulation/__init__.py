"""Time: how does a mechanism move from its start to its end?

In: a `Scene` or a saved state, a duration, tolerances. Out: a `Trajectory`. `simulate` is the door, `runner` drives the loop
from Python, `advance` is the event loop, `moreau` its independent twin. Below: `events`, `motion`, `record`, then `scratch`,
`buffers`, `state`, `options` and `stops`. Imports `dynamics` and all below.
"""
