"""How does a trajectory become pictures: plots, stills, movies?

In: a `Trajectory`, a `Scene` or a `Drawing`. Out: PNG, MP4, GIF. The only package that imports matplotlib and imageio.
Imports `simulation`, `mechanism`, `drawing` and below; no number is made here.
"""
