"""What does a second core do while a run is stepped, and after it?

In: the scene, and events and rows as they settle. Out: texts and pictures for the results folder. `commands.run` and
`commands.demo` call it.
"""
