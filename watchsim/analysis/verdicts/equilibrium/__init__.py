"""How do the bodies of a watch that stands hold each other: lever arms, contacts in force, torques?

In: a `Trajectory` and a time. Out: the contacts in force, their lever arms, and the torques at the lever. Imports
`simulation`, `dynamics` and below.
"""
