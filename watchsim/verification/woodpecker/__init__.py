"""Does the woodpecker toy come out?

In: the published data of the toy. Out: rows of its cycle against an exact motion, published runs and time stepping.
`woodpecker_rows` is the door. Imports `verification` for bare contacts and comparison, `simulation.moreau` for its laws.
"""
