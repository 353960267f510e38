"""How is each table of a scene file read? One file a table.

In: tables of TOML. Out: the records of `scene`; faults are collected, none is raised. Imports `scene.file.outlines`,
`scene.file.keys` and the records of `scene`.
"""
