"""How is a shape drawn hundreds of times whose look never changes?

A patch of matplotlib works its look out anew whenever it is drawn, which for small shapes costs more than the shape itself.
"""

from __future__ import annotations

from typing import Any

from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.colors import to_rgba
from matplotlib.patches import PathPatch


class LastingPatch(PathPatch):
    """A patch whose colours, lines and clip box are final when it is first drawn; its path and transform may go on changing."""

    _context: GraphicsContextBase | None = None
    _face: Any = None

    def draw(self, renderer: RendererBase) -> None:
        """Draw it with the look that it had when it was first drawn."""
        if self._context is None:
            self._context, self._face = self._look(renderer)
        renderer.draw_path(self._context, self.get_path(), self.get_transform(), self._face)

    def _look(self, renderer: RendererBase) -> tuple[GraphicsContextBase, Any]:
        """The context for its edge, and the colour of its face (None: left empty)."""
        context = renderer.new_gc()
        edge, face = to_rgba(self.get_edgecolor()), to_rgba(self.get_facecolor())
        if (alpha := self.get_alpha()) is not None:  # any other would take the place of what the colours have
            context.set_alpha(alpha)
        context.set_foreground(edge, isRGBA=True)
        context.set_linewidth(self.get_linewidth() if edge[3] else 0.0)
        context.set_capstyle(self.get_capstyle())
        context.set_joinstyle(self.get_joinstyle())
        context.set_clip_rectangle(self.get_clip_box())
        return context, face if face[3] else None
