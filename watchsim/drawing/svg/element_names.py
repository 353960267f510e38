"""Which names of elements and attributes does SVG know, and what becomes of the elements?"""

from __future__ import annotations

CONTAINERS = frozenset(("g", "a", "svg"))
SILENT = frozenset(  # neither drawn by themselves nor missed
    (
        *("defs", "symbol", "clipPath", "mask", "pattern", "marker", "linearGradient", "radialGradient", "meshgradient"),
        *("filter", "style", "script", "title", "desc", "metadata", "view", "cursor", "font", "font-face", "glyph", "stop"),
        *(
            "animate",
            "animateColor",
            "animateMotion",
            "animateTransform",
            "set",
            "solidcolor",
            "hatch",
            "color-profile",
            "discard",
        ),
    )
)
TEXT_LIKE = frozenset(
    (
        *("text", "tspan", "textPath", "tref", "image", "foreignObject", "flowRoot", "flowPara", "flowRegion", "altGlyph"),
        *("video", "audio", "canvas", "iframe", "mesh"),
    )
)
MOVING = frozenset(("animateMotion", "animateTransform"))
_ANY = frozenset(
    (
        *("id", "class", "style", "transform", "lang", "tabindex", "requiredFeatures", "requiredExtensions", "systemLanguage"),
        *("externalResourcesRequired", "pathLength", "transform-origin", "transform-box", "autofocus", "role", "space", "base"),
        *("alignment-baseline", "baseline-shift", "clip", "clip-path", "clip-rule", "color", "color-interpolation"),
        *("color-interpolation-filters", "color-profile", "color-rendering", "cursor", "direction", "display"),
        *("dominant-baseline", "enable-background", "fill", "fill-opacity", "fill-rule", "filter", "flood-color"),
        *("flood-opacity", "font", "font-family", "font-size", "font-size-adjust", "font-stretch", "font-style"),
        *("font-variant", "font-weight", "glyph-orientation-horizontal", "glyph-orientation-vertical", "image-rendering"),
        *("kerning", "letter-spacing", "lighting-color", "marker", "marker-end", "marker-mid", "marker-start", "mask"),
        *("opacity", "overflow", "paint-order", "pointer-events", "shape-rendering", "solid-color", "solid-opacity"),
        *("stop-color", "stop-opacity", "stroke", "stroke-dasharray", "stroke-dashoffset", "stroke-linecap"),
        *("stroke-linejoin", "stroke-miterlimit", "stroke-opacity", "stroke-width", "text-align", "text-anchor"),
        *("text-decoration", "text-overflow", "text-rendering", "unicode-bidi", "vector-effect", "visibility", "white-space"),
        *("word-spacing", "writing-mode", "mix-blend-mode", "isolation", "line-height", "xmlns"),
    )
)
_OWN = {
    "path": frozenset("d"),
    "line": frozenset(("x1", "y1", "x2", "y2")),
    "polyline": frozenset(("points",)),
    "polygon": frozenset(("points",)),
    "rect": frozenset(("x", "y", "width", "height", "rx", "ry")),
    "circle": frozenset(("cx", "cy", "r")),
    "ellipse": frozenset(("cx", "cy", "rx", "ry")),
    "use": frozenset(("x", "y", "width", "height", "href")),
    "g": frozenset(("x", "y", "width", "height")),  # without meaning, and often written
    "svg": frozenset(
        (
            *("x", "y", "width", "height", "viewBox", "preserveAspectRatio", "version", "baseProfile", "zoomAndPan"),
            *("contentScriptType", "contentStyleType"),
        )
    ),
    "symbol": frozenset(("x", "y", "width", "height", "viewBox", "preserveAspectRatio", "refX", "refY")),
    "defs": frozenset(),
    "switch": frozenset(),
}


def strange_attributes(tag: str, attributes: dict[str, str]) -> list[str]:
    """Attributes that this element cannot have: perhaps a damaged name, whose value is then missing."""
    own = _OWN.get(tag)
    if own is None:
        return []
    return [
        name
        for name in attributes
        if name not in _ANY and name not in own and ":" not in name and not name.startswith(("on", "data-", "aria-"))
    ]
