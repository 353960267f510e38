"""What does a run sound like?

In: a `Trajectory` with its impacts. Out: when which blow sounds (`score`), and a WAV file (`wav`). Imports `analysis.timing`,
`simulation` and `storage`.
"""
