"""How does a trajectory become pictures: plots, stills, movies?

In: a `Trajectory`, a `Scene` or a `Drawing`. Out: PNG, MP4, GIF. The only package that imports matplotlib and imageio.
Imports `simulation`, `mechanism`, `drawing` and below; no number is made here.
"""


def without_help() -> None:
    """Have matplotlib make no help texts about properties when it is loaded: a third of its loading."""
    from matplotlib.artist import Artist

    if hasattr(Artist, "_update_set_signature_and_docstring"):
        Artist._update_set_signature_and_docstring = classmethod(lambda _: None)
