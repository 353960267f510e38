"""Where do the numbered circles and their numbers go, so that every number can be read?

Faults a hair apart share a circle. Numbers are put beside their circle where they cover the least of other circles and
numbers, further out with a thin line where it is crowded. All in points on the paper.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.findings import ORDER, Finding
from watchsim.geometry.primitives import Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FAULT = "#d0021b"
CIRCLED = 80  # more circles would cover the part
RADIUS = 6.5  # of a circle
CLOSE = 6.0  # faults this close share a circle
LETTER, LINE = 5.9, 9.5  # width of a digit and height of a number
REACHES = (10.5, 21.0, 35.0, 50.0, 65.0, 80.0)  # from the centre of a circle to the near side of its number
WAYS = 12
GROUPS = 2  # numbers or ranges of numbers written at one circle

Box = tuple[float, float, float, float]


def fault_circles(axes: Axes, findings: Sequence[Finding]) -> int:
    """Draws circles with the numbers of the report, the gravest first; returns how many faults with a place have none."""
    from matplotlib.figure import Figure

    numbered = sorted(enumerate(findings, 1), key=lambda pair: ORDER.index(pair[1].severity))
    placed = [(k, x, y) for k, finding in numbered for x, y in places(finding)]
    if not placed:
        return 0
    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    figure.draw_without_rendering()  # the layout is settled only then
    scale = 72.0 / figure.dpi
    points = scale * axes.transData.transform(np.array([(x, y) for _, x, y in placed]))
    circles, left = shared([(number, point) for (number, _, _), point in zip(placed, points, strict=True)])
    frame = scale * np.array(axes.get_window_extent().extents)
    centres = np.array([centre for centre, _ in circles])
    taken = [(x - RADIUS, y - RADIUS, x + RADIUS, y + RADIUS) for x, y in centres.tolist()]
    for centre, numbers in sorted(circles, key=lambda circle: min(circle[1])):
        box, text = label(centre, numbers, np.array(taken), frame)
        taken.append(box)
        _draw(axes, tuple(axes.transData.inverted().transform(centre / scale)), centre, text, box)
    return left


def places(finding: Finding) -> list[Point]:
    """Where in the drawing (mm) it is: nowhere, at one place, or at both ends of a gap."""
    if finding.x_mm is None or finding.y_mm is None:
        return []
    return [(finding.x_mm, finding.y_mm), *([finding.other_mm] if finding.other_mm else [])]


def shared(points: Sequence[tuple[int, NDArray[np.float64]]]) -> tuple[list[tuple[NDArray[np.float64], list[int]]], int]:
    """Circles (centre, numbers of their faults), at most CIRCLED, and how many faults found no place at all."""
    circles: list[tuple[NDArray[np.float64], list[int]]] = []
    left: set[int] = set()
    for number, point in points:
        near = next((numbers for centre, numbers in circles if math.dist(centre, point) <= CLOSE), None)
        if near is not None:
            near += [number] if number not in near else []
        elif len(circles) < CIRCLED:
            circles.append((point, [number]))
        else:
            left.add(number)
    return circles, len(left.difference(*(numbers for _, numbers in circles)))


def in_ranges(numbers: Sequence[int]) -> str:
    """ "3, 7–12 …": at most GROUPS numbers or ranges."""
    groups: list[list[int]] = []
    for number in sorted(numbers):
        if groups and number == groups[-1][-1] + 1:
            groups[-1].append(number)
        else:
            groups.append([number])
    texts = [f"{g[0]}–{g[-1]}" if len(g) > 2 else ", ".join(map(str, g)) for g in groups]
    return ", ".join(texts[:GROUPS]) + (f" … (in all {len(numbers)})" if len(texts) > GROUPS else "")


def label(
    centre: NDArray[np.float64], numbers: Sequence[int], taken: NDArray[np.float64], frame: NDArray[np.float64]
) -> tuple[Box, str]:
    """Box and text of a circle's numbers; where all of them have no room, the first alone and how many more there are."""
    full = in_ranges(numbers)
    box, covered = best_box(centre, LETTER * len(full), taken, frame)
    short = f"{min(numbers)} +{len(numbers) - 1}"
    if covered == 0.0 or len(short) >= len(full):
        return box, full
    return best_box(centre, LETTER * len(short), taken, frame)[0], short


def best_box(
    centre: NDArray[np.float64], width: float, taken: NDArray[np.float64], frame: NDArray[np.float64]
) -> tuple[Box, float]:
    """The place of a number of that width that covers least, and the area it covers; upper right before others."""
    best, least, hidden = (0.0, 0.0, 0.0, 0.0), math.inf, 0.0
    for reach in REACHES:
        for k in range(WAYS):
            angle = math.pi / 4.0 - math.tau * k / WAYS
            c, s = math.cos(angle), math.sin(angle)
            x = centre[0] + reach * c + 0.5 * width * (c / max(abs(c), 0.5))
            y = centre[1] + reach * s
            box = (x - 0.5 * width, y - 0.5 * LINE, x + 0.5 * width, y + 0.5 * LINE)
            wide = np.minimum(box[2], taken[:, 2]) - np.maximum(box[0], taken[:, 0])
            high = np.minimum(box[3], taken[:, 3]) - np.maximum(box[1], taken[:, 1])
            covered = float(np.sum(np.maximum(wide, 0.0) * np.maximum(high, 0.0)))
            outside = box[0] < frame[0] or box[1] < frame[1] or box[2] > frame[2] or box[3] > frame[3]
            cost = covered + (width * LINE if outside else 0.0) + 0.5 * (reach - REACHES[0])
            if cost < least - 1e-9:
                best, least, hidden = box, cost, covered
    return best, hidden


def _draw(axes: Axes, place: Point, centre: NDArray[np.float64], text: str, box: Box) -> None:
    from matplotlib.patheffects import withStroke

    x, y = place
    middle = (0.5 * (box[0] + box[2]) - centre[0], 0.5 * (box[1] + box[3]) - centre[1])
    ring = 2.0 * RADIUS
    axes.plot(x, y, "o", markersize=ring, markerfacecolor="none", markeredgecolor=FAULT, markeredgewidth=1.4, zorder=6)
    gap = math.hypot(max(abs(middle[0]) - 0.5 * (box[2] - box[0]), 0.0), middle[1])
    far = gap > REACHES[0] + 0.5 * LINE
    axes.annotate(
        *(text, (x, y), middle, "data", "offset points"),
        color=FAULT,
        fontsize=8,
        fontweight="bold",
        ha="center",
        va="center",
        zorder=7,
        annotation_clip=False,
        arrowprops={"arrowstyle": "-", "color": FAULT, "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": RADIUS} if far else None,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )
