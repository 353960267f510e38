"""Which outlines does a body of a scene file have, and where is its pivot in the drawing?

In: the table of a body and its drawing. Out: loops in the body's own frame, metres. Imports `scene.file.keys`, `drawing`
and `geometry`.
"""
