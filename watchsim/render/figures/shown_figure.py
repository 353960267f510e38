"""How does a figure show itself in a notebook, without a magic word?"""

from __future__ import annotations

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

SCREEN = 134  # dots per inch: a page's width is 900 dots, in which letters of 6 pt can be read
COLOURS = 32  # of a small picture: a palette makes it small


class ShownFigure(Figure):
    """A figure that notebooks show as a picture, whether or not they have been told about matplotlib."""

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        FigureCanvasAgg(self)
        self.savefig(out, format="png", dpi=SCREEN)
        return out.getvalue()


def small_png(figure: Figure, dots: int) -> bytes:
    """A figure so many dots wide, in few colours."""
    from PIL import Image

    out, small = io.BytesIO(), io.BytesIO()
    figure.savefig(out, format="png", dpi=dots / figure.get_figwidth())
    Image.open(out).convert("RGB").quantize(COLOURS).save(small, "PNG", optimize=True)
    return small.getvalue()
