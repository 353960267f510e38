"""How is a mechanism drawn from its dimensions?

In: dimensions with limits and sources. Out: outlines (`Sheet`) and the text of a scene. One file a mechanism, found by
`registry`; `scene_builder`, `outline` and `parts` hold what several share. Imports `drawing` and `geometry`, no scene.
"""
