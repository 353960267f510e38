"""How does a run become a film: which instants, at what pace, in which file format?

In: a `Trajectory` and a window. Out: MP4 or GIF (`run_movie`); `turn_movie` films a mechanism turned by hand. Imports
`render.frame`, `analysis`, `turning` and `storage`.
"""
