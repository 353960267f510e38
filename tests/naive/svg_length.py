"""How much does a small SVG file draw, by the plainest reading?

Elements as expat reports them, points by `svg_curve`, lengths by chords. Knows what the samples of the fuzzer hold, in user
units only; whatever else it meets raises an exception. Shares no code with the package.
"""

import math
import re
import xml.etree.ElementTree as ET
from xml.parsers import expat

import numpy as np
from svg_curve import mapped, matrix, points

UNITS = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "px": 25.4 / 96, "": 25.4 / 96}
ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
DRAWN = ("path", "rect", "circle", "ellipse", "polygon", "polyline", "line")


def tree(data: bytes) -> ET.Element:
    """The elements with their names as written: prefixes need not be declared."""
    builder = ET.TreeBuilder()
    parser = expat.ParserCreate()
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.Parse(data, True)
    return builder.close()


def local(element: ET.Element) -> str:
    return element.tag.rpartition(":")[2]


def length(data: bytes) -> float:
    """The length of everything drawn, in units of the page: those of its width, else pixels."""
    root = tree(data)
    sizes = [re.fullmatch(r"([\d.]+)([a-z]*)", root.get(side, "")) for side in ("width", "height")]
    first, second = ((float(size[1]), size[2]) for size in sizes if size)
    assert first[1] == second[1]
    pixels = UNITS[first[1]] / UNITS["px"] if first[1] else 1.0
    by = np.diag([1 / pixels, 1 / pixels, 1.0]) @ shown(root, first[0] * pixels, second[0] * pixels)
    ids = {element.get("id"): element for element in root.iter()}
    return sum(within(child, by, ids, 0) for child in root)


def shown(element: ET.Element, width: float, height: float) -> np.ndarray:
    """The map of the element's view box into a viewport of that size."""
    if element.get("viewBox") is None:
        return np.eye(3)
    x, y, w, h = map(float, re.split(r"[ ,]+", element.get("viewBox", "").strip()))
    words = element.get("preserveAspectRatio", "xMidYMid meet").split()
    sx, sy = width / w, height / h
    if words[0] == "none":
        return np.diag([sx, sy, 1.0]) @ matrix("translate", -x, -y)
    scale = max(sx, sy) if words[1:] == ["slice"] else min(sx, sy)
    return np.diag([scale, scale, 1.0]) @ matrix("translate", -x, -y)  # alignment changes no length


def within(element: ET.Element, outer: np.ndarray, ids: dict, depth: int) -> float:
    assert depth < 20
    kind = local(element)
    if kind in ("defs", "symbol", "style", "title"):
        return 0.0
    by = outer
    functions = re.findall(r"(\w+)\(([^()]*)\)", element.get("transform", ""))
    for name, arguments in functions:
        by = by @ matrix(name, *map(float, re.split(r"[ ,]+", arguments.strip())))
    if kind == "use":
        target = ids[element.get("href", element.get("xlink:href", "")).removeprefix("#")]
        by = by @ matrix("translate", float(element.get("x", 0)), float(element.get("y", 0)))
        if local(target) == "symbol":
            by = by @ shown(target, float(element.get("width", "")), float(element.get("height", "")))
            return sum(within(child, by, ids, depth + 1) for child in target)
        return within(target, by, ids, depth + 1)
    if kind == "svg":
        by = by @ shown(element, float(element.get("width", "")), float(element.get("height", "")))
    if kind in DRAWN:
        return math.fsum(chords(mapped(by, curve)) for curve in curves(kind, element.attrib))
    assert kind in ("g", "svg", "switch", "a")
    return sum(within(child, by, ids, depth + 1) for child in element)


def chords(curve: np.ndarray) -> float:
    return float(np.sum(np.hypot(*np.diff(curve, axis=0).T)))


def curves(kind: str, given: dict[str, str]) -> list[np.ndarray]:
    """The points of each piece of an element, in its own coordinates."""
    a = {name: float(given.get(name, 0.0)) for name in ("x", "y", "width", "height", "cx", "cy", "r", "x1", "y1", "x2", "y2")}
    turn = np.linspace(0.0, 2.0 * math.pi, 400)
    if kind in ("circle", "ellipse"):
        rx, ry = (float(given[n]) for n in ("rx", "ry")) if kind == "ellipse" else (a["r"], a["r"])
        assert rx >= 0.0 and ry >= 0.0
        return [np.column_stack((a["cx"] + rx * np.cos(turn), a["cy"] + ry * np.sin(turn)))]
    if kind == "rect":
        rx = float(given.get("rx", given.get("ry", 0.0)))
        rx, ry = min(rx, a["width"] / 2), min(float(given.get("ry", rx)), a["height"] / 2)
        assert min(rx, ry, a["width"], a["height"]) >= 0.0
        corner = np.column_stack((rx * np.cos(turn), ry * np.sin(turn)))
        sides = np.array([[0.0, 0.0], [2 * (a["width"] - 2 * rx) + 2 * (a["height"] - 2 * ry), 0.0]])
        return [corner, sides] if rx and ry else [np.array([[0.0, 0.0], [2 * (a["width"] + a["height"]), 0.0]])]
    if kind == "line":
        return [np.array([[a["x1"], a["y1"]], [a["x2"], a["y2"]]])]
    if kind == "path":
        return [points(part, 400) for part in subpaths(given["d"]) if len(part) > 1]
    corners = np.array(list(map(float, re.split(r"[\s,]+", given["points"].strip())))).reshape(-1, 2)
    return [np.vstack((corners, corners[:1])) if kind == "polygon" else corners]


def subpaths(d: str) -> list[list[tuple]]:
    """Absolute commands of each subpath; numbers are taken by their grammar, flags by their digit."""
    result: list[list[tuple]] = []
    x = y = sx = sy = 0.0
    for letter, text in re.findall(r"([MmZzLlHhVvCcSsQqTtAa])([^MmZzLlHhVvCcSsQqTtAa]*)", d):
        kind, relative = letter.upper(), letter.islower()
        number = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
        flagged = re.sub(rf"(({number}[\s,]*){{3}})([01])[\s,]*([01])[\s,]*", r"\1 \3 \4 ", text)
        values = list(map(float, re.findall(number, flagged if kind == "A" else text)))
        assert not re.sub(rf"{number}|[\s,]", "", text)
        size = ARGUMENTS[kind]
        rows = [values[k : k + size] for k in range(0, len(values), size)] if size else [[]]
        assert rows and all(len(row) == size for row in rows)
        for k, row in enumerate(rows):
            name = "L" if kind == "M" and k else kind
            dx, dy = (x, y) if relative else (0.0, 0.0)
            shifts = {"H": [dx], "V": [dy], "A": [0, 0, 0, 0, 0, dx, dy]}.get(name, [dx, dy] * (size // 2))
            a = [value + shift for value, shift in zip(row, shifts, strict=True)]
            if name == "M" or not result or result[-1][-1][0] == "Z":
                result.append([("M", *a)] if name == "M" else [("M", sx, sy)])
            if name == "M":
                sx, sy = a
            else:
                result[-1].append((name, *a))
            x = sx if name == "Z" else x if name == "V" else a[0] if name == "H" else a[-2]
            y = sy if name == "Z" else y if name == "H" else a[-1]
    return result
