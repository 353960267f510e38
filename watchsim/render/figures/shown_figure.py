"""How does a figure show itself in a notebook, without a magic word?"""

from __future__ import annotations

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

SCREEN = 96  # dots per inch


class ShownFigure(Figure):
    """A figure that notebooks show as a picture, whether or not they have been told about matplotlib."""

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        FigureCanvasAgg(self)
        self.savefig(out, format="png", dpi=SCREEN)
        return out.getvalue()
