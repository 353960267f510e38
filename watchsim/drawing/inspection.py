"""What should the user know about this drawing?

The same facts twice: as a dictionary with fixed names for programs, and as text for people.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

from watchsim.drawing.chain_faults import shown
from watchsim.drawing.circles import circle_lines, circle_reports
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import ORDER, Finding
from watchsim.drawing.material import layer_area, layer_roles, material_area
from watchsim.geometry.loops import Box, Loop, extents, total_length
from watchsim.geometry.primitives import Arc, Point
from watchsim.geometry.solids import area

ENTITY = re.compile(r"[A-Z0-9_]+ (#\w+|\(line [^)]*\))")  # in a message
PLACED = re.compile(r"\([-−]?\d[^()]*, [-−]?\d[^()]*\)")  # coordinates in a message
FEW = 8  # points of a layer written out
SHOWN = 12  # findings of one code written out in the text
SAID = {"material": "", "bore": " taken out", "mark": ", no material"}
LARGEST, SMALL = 10.0, 1e-5  # m: shown in millimetres below and from there on
NOTHING = 1e-12  # m; deviations below are those of floating point


def inspect_report(drawing: Drawing) -> dict[str, object]:
    """The facts under the names of `watchsim inspect --json`; lengths in mm, areas in mm², deviation in µm."""
    everything = (*drawing.loops, *drawing.open_chains)
    lines, arcs = counts(everything)
    box = extents(everything)
    return {
        "file": str(drawing.path),
        "format": drawing.format,
        "units": drawing.units,
        "units_from": drawing.units_from,
        "extents_mm": [1e3 * side for side in box] if box else None,
        "layers": {layer: layer_report(loops, chains) for layer, (loops, chains) in by_layer(drawing).items()},
        "loops": [loop_report(loop) for loop in everything],
        "points": [{"layer": layer, "x_mm": 1e3 * x, "y_mm": 1e3 * y} for layer, x, y in drawing.points],
        "fitted": {
            "curves": drawing.fitted_curves,
            "arcs": drawing.fitted_arcs,
            "worst_deviation_um": 1e6 * drawing.fitted_deviation,
        },
        "drawn": {"kinds": dict(drawing.drawn.kinds), "length_mm": 1e3 * drawing.drawn.length},
        "ignored": dict(drawing.ignored),
        "findings": [finding.as_dict() for finding in drawing.findings],
        "lines": lines,
        "arcs": arcs,
        "length_mm": 1e3 * total_length(everything),
        "area_mm2": 1e6 * material_area(drawing.loops),
        "circles": circle_reports(drawing.loops),
        **(_section_report(drawing) if drawing.slabs else {}),
    }


def _section_report(drawing: Drawing) -> dict[str, object]:
    """Of a solid: where it is cut, and between which heights its section stays the same."""
    slabs = [{"from_mm": 1e3 * one.bottom, "to_mm": 1e3 * one.top, "same": one.same} for one in drawing.slabs]
    return {"section_mm": 1e3 * (drawing.section or 0.0), "slabs": slabs}


def counts(loops: Iterable[Loop]) -> tuple[int, int]:
    """How many lines and how many arcs (a circle is one)."""
    edges = [edge for loop in loops for edge in loop.edges]
    arcs = sum(isinstance(edge, Arc) for edge in edges)
    return len(edges) - arcs, arcs


def by_layer(drawing: Drawing) -> dict[str, tuple[list[Loop], list[Loop]]]:
    """Loops and open chains of each layer, all layers in order."""
    result: dict[str, tuple[list[Loop], list[Loop]]] = {layer: ([], []) for layer in drawing.layers}
    for k, loops in enumerate((drawing.loops, drawing.open_chains)):
        for loop in loops:
            result.setdefault(loop.layer, ([], []))[k].append(loop)
    return result


def layer_report(loops: Sequence[Loop], chains: Sequence[Loop]) -> dict[str, int]:
    lines, arcs = counts([*loops, *chains])
    return {"lines": lines, "arcs": arcs, "loops": len(loops), "open_chains": len(chains)}


def loop_report(loop: Loop) -> dict[str, object]:
    lines, arcs = counts([loop])
    return {
        "layer": loop.layer,
        "lines": lines,
        "arcs": arcs,
        "area_mm2": 1e6 * abs(area(loop)) if loop.closed else 0.0,
        "length_mm": 1e3 * loop.length,
        "closed": loop.closed,
        "hole": loop.hole,
    }


def inspect_text(drawing: Drawing) -> str:
    """The same facts in words, the most important first."""
    everything = (*drawing.loops, *drawing.open_chains)
    parts = [str(drawing.path)]
    if drawing.layers or drawing.units:
        parts += [
            *units_lines(drawing),
            *section_lines(drawing),
            *size_lines(drawing, extents(everything)),
            *layer_lines(drawing),
        ]
    if drawing.fitted_curves:
        deviation = drawing.fitted_deviation
        worst = f"{1e6 * deviation:.3g} µm" if deviation > NOTHING else f"{1e12 * NOTHING:g} pm"
        curves = plural(drawing.fitted_curves, "curve")
        parts.append(f"  {curves} followed by {plural(drawing.fitted_arcs, 'arc')}, nowhere further away than {worst}")
    if drawing.ignored:
        parts.append("  not read: " + ", ".join(f"{count} {kind}" for kind, count in drawing.ignored.items()))
    parts += finding_lines(drawing.findings)
    return "\n".join(parts)


def plural(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def units_lines(drawing: Drawing) -> list[str]:
    if drawing.units is None:
        return ["  units: not stated; lengths are shown as if in mm"]
    origin = {"header": "as the file says", "option": "as you say", "page": "as the page says"}
    return [f"  units: {drawing.units}, {origin.get(drawing.units_from or '', 'unknown origin')}"]


def section_lines(drawing: Drawing) -> list[str]:
    """The same for people."""
    if drawing.section is None:
        return []
    rows = [
        f"    {1e3 * one.bottom:.6g} to {1e3 * one.top:.6g} mm, {'the same all the way' if one.same else 'changes'}"
        for one in drawing.slabs[:SHOWN]
    ]
    more = [f"    and {len(drawing.slabs) - SHOWN} more"] if len(drawing.slabs) > SHOWN else []
    return [f"  cut at {1e3 * drawing.section:.6g} mm; its sections by height:", *rows, *more]


def size_lines(drawing: Drawing, box: Box | None) -> list[str]:
    if box is None:
        return ["  nothing to measure"]
    name, unit = _unit_for(max(box[2] - box[0], box[3] - box[1]))
    width, height = (box[2] - box[0]) / unit, (box[3] - box[1]) / unit
    x, y = (f"{placed(box[k] / unit, width, height)} to {placed(box[k + 2] / unit, width, height)}" for k in (0, 1))
    everything = (*drawing.loops, *drawing.open_chains)
    lines, arcs = counts(everything)
    return [
        f"  the part is {three_digits(max(width, height))} {name} across ({width:.4g} × {height:.4g} {name}; x {x}, y {y})",
        f"  {plural(len(drawing.loops), 'closed outline')}, {plural(len(drawing.open_chains), 'open chain')}: "
        f"{plural(lines, 'line')} and {plural(arcs, 'arc')}, {total_length(everything) / unit:.5g} {name} long, "
        f"{material_area(drawing.loops) / unit**2:.5g} {name}² {_covered(drawing.loops)}",
    ]


def _unit_for(size: float) -> tuple[str, float]:
    """Millimetres, but for what is far too large or too small for them."""
    return ("m", 1.0) if size >= LARGEST else ("µm", 1e-6) if size < SMALL else ("mm", 1e-3)


def _covered(loops: Iterable[Loop]) -> str:
    """What the area is: layers may lie above each other."""
    return "of material" if list(layer_roles(loops).values()).count("material") < 2 else "of material in all layers added up"


def three_digits(value: float) -> str:
    """ "4.30", "12.0", "1016": at least three digits, also where they are zero."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:#.3g}"


def placed(value: float, *sizes: float) -> str:
    """A coordinate to a thousandth of the size of what lies there, or better, however far off the origin."""
    decimals = min(max(0, 3 - math.floor(math.log10(max(*sizes, 1e-9)))), 9)
    text = f"{round(value, decimals) + 0.0:.{decimals}f}"  # no minus before a zero
    return text.rstrip("0").rstrip(".") if decimals else text


def layer_lines(drawing: Drawing) -> list[str]:
    """One row per layer, aligned."""
    result = []
    roles = layer_roles(drawing.loops)
    width = max((len(layer) for layer in drawing.layers), default=0)
    places: dict[str, list[Point]] = {}
    for name, x, y in drawing.points:
        places.setdefault(name, []).append((x, y))
    for layer, (loops, chains) in by_layer(drawing).items():
        facts = layer_report(loops, chains)
        holes = sum(loop.hole for loop in loops)
        points = places.get(layer, [])
        words = [plural(facts["loops"], "outline") + (f" ({plural(holes, 'hole')})" if holes else "")] if facts["loops"] else []
        words += [plural(facts["open_chains"], "open chain")] if facts["open_chains"] else []
        words += [plural(facts[f"{kind}s"], kind) for kind in ("line", "arc") if facts[f"{kind}s"]]
        words += [f"{1e6 * layer_area(loops):.5g} mm²{SAID[roles[layer]]}"] if loops else []
        if len(points) == 1:
            words.append(f"a point at ({1e3 * points[0][0]:.6g}, {1e3 * points[0][1]:.6g}) mm")
        elif points:
            words.append(plural(len(points), "point") + _places(points))
        result.append(f"    {layer:<{width}}  {', '.join(words)}")
        result += [f"    {'':<{width}}  {line}" for line in circle_lines(loops)]
    return ["  layers:", *result] if result else []


def _places(points: Sequence[Point]) -> str:
    """Where several points lie, as far as they can be read at a glance."""
    places = ", ".join(f"({1e3 * x:.6g}, {1e3 * y:.6g})" for x, y in points[:FEW])
    return f" at {places}{' mm' if len(points) <= FEW else ' mm, ...'}"


def _place(finding: Finding) -> str:
    """Coordinates, where the finding has some and its message does not give them."""
    if finding.x_mm is None or finding.y_mm is None:
        return ""
    return "" if PLACED.search(finding.message) else f", at {shown((1e-3 * finding.x_mm, 1e-3 * finding.y_mm))} mm"


def finding_lines(findings: Iterable[Finding]) -> list[str]:
    """Findings by severity, numbered as in the picture; alike ones without a place are one, many of one kind are cut short."""
    numbered = sorted(enumerate(findings, 1), key=lambda pair: ORDER.index(pair[1].severity))
    if not numbered:
        return ["  no faults found"]
    result = ["  findings:"]
    alike = Counter(_without_entity(finding) for _, finding in numbered)
    listed, left = Counter[str](), Counter[str]()
    fixes: set[str] = set()
    for number, finding in numbered:
        count = alike.pop(_without_entity(finding), 0)  # 0: one like it was listed
        if count and listed[finding.code] == SHOWN:
            left[finding.code] += count
        elif count:
            listed[finding.code] += 1
            where = f" [layer {finding.layer}]" if finding.layer is not None else ""
            more = f" (and {count - 1} more alike)" if count > 1 else ""
            place = _place(finding)
            result.append(f"    {number:>3}. {finding.severity} ({finding.code}){where}: {finding.message}{place}{more}")
            result += [f"        {finding.fix}"] if finding.fix and finding.fix not in fixes else []
            fixes.add(finding.fix)
    result += [f"        and {count} more of {code}" for code, count in left.items()]
    return result


def _without_entity(finding: Finding) -> Finding:
    """What findings have in common that name no place, but each an entity."""
    return finding if finding.x_mm is not None else replace(finding, message=ENTITY.sub("", finding.message))
