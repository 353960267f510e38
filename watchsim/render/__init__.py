"""From a trajectory to pictures: plots, frames, movies."""
