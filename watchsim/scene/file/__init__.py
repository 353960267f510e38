"""How does a scene file become a scene, and how is one value of it changed?

In: a TOML file, or the mapping it holds. Out: a `Scene`, or one `SceneError` that lists all faults with line and key.
`load` and `override` call `readers`, these `outlines`, these `keys`. Imports the records of `scene`.
"""
