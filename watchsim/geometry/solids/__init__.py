"""What do outlines weigh: area, centroid and inertia of flat parts, of turned parts, of hairsprings; and their meshes?

In: loops in metres, densities. Out: masses and moments in SI, polygons of an area, trimesh's meshes and paths.
Imports the rest of `geometry` but for `fitting`.
"""
