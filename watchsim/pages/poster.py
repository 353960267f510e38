"""The still picture of a page: for paper, and for readers that run no scripts."""

from __future__ import annotations

import math

import numpy as np

from watchsim.pages.html import Markup, element
from watchsim.pages.player.canvas_outlines import path_data
from watchsim.render.frame.coils import hairsprings
from watchsim.render.frame.filled_parts import Part
from watchsim.render.frame.line_spring_shapes import zigzags
from watchsim.render.frame.pose_history import Window, poses
from watchsim.render.frame.view import Frame, View, room_of, view
from watchsim.render.palette import BLUED, mixed
from watchsim.render.picture_style import LIGHT, PALE
from watchsim.simulation.record.trajectory import Array, Trajectory

MARGIN = 0.04
MOST = 150_000  # characters of path data; more than that is left to the player
MM = 1e3
COIL = 1e-3  # of its size, that a chord may stray from a hairspring
FRAME = Frame(0.0, 0.0, 1280.0, 720.0)


def poster(run: Trajectory, window: Window, parts: tuple[Part, ...], t: float) -> Markup:
    """All parts at the instant `t` (s), as SVG in mm; the player moves the groups when the page is printed."""
    drawn = [path_data(part.outlines) for part in parts]
    if sum(map(len, drawn)) > MOST:
        return Markup("")
    frames = {name: frame[0] for name, frame in poses(run, np.array([t])).items()}
    seen = view(run, window, FRAME, None, None)
    left, bottom, right, top = _box(run, window, seen, frames)
    pad = MARGIN * max(right - left, top - bottom)
    c, s = math.cos(seen.turn), math.sin(seen.turn)
    place = (c, -s, -s, -c, MM * (pad - left), MM * (pad + top))
    groups = [
        element(
            "g",
            element(
                "path",
                d=data,
                fill="none" if part.ground else LIGHT.worn(part.finish).fill,
                stroke=LIGHT.worn(part.finish).edge,
            ),
            transform=_matrix(*_pose(frames[part.body])),
            data_part=number,
        )
        for number, (part, data) in enumerate(zip(parts, drawn, strict=True))
    ]
    coils = [
        element(
            "path",
            d=_points(spring.line(frames, spring.coil.chords(COIL * spring.coil.outer))),
            fill="none",
            stroke=mixed(BLUED.line, LIGHT.background, PALE),
            stroke_width=f"{MM * spring.coil.width:.4g}",
            data_coil=number,
        )
        for number, spring in enumerate(hairsprings(run.scene))
    ]
    lines = [
        element("path", d=_points(spring.line(frames)), fill="none", stroke=BLUED.line, data_zigzag=number)
        for number, spring in enumerate(zigzags(run.scene))
    ]
    width, height = MM * (right - left + 2.0 * pad), MM * (top - bottom + 2.0 * pad)
    return element(
        "svg",
        element("g", *coils, *groups, *lines, transform=_matrix(*place)),
        id="poster",
        viewBox=f"0 0 {width:.4f} {height:.4f}",
        role="img",
        aria_label=f"The mechanism at {t:.6g} s",
    )


def _box(run: Trajectory, window: Window, seen: View, frames: dict[str, Array]) -> tuple[float, float, float, float]:
    """Least and largest x and y (m) in the turned picture."""
    c, s = math.cos(seen.turn), math.sin(seen.turn)
    if seen.follow is None:
        points = room_of(run, window, None)[0] @ np.array([[c, s], [-s, c]])
        (left, bottom), (right, top) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        return left, bottom, right, top
    x, y = seen.centre_at(frames)
    across, along = c * x - s * y, s * x + c * y
    half_width, half_height = 0.5 * FRAME.width / seen.scale, 0.5 * FRAME.height / seen.scale
    return across - half_width, along - half_height, across + half_width, along + half_height


def _pose(frame: Array) -> tuple[float, ...]:
    x, y, angle = frame.tolist()
    c, s = math.cos(angle), math.sin(angle)
    return c, s, -s, c, MM * x, MM * y


def _points(line: Array) -> str:
    """A line through points (n, 2), m, as SVG path data in mm."""
    return "M" + " ".join(f"{MM * x:.4f} {MM * y:.4f}" for x, y in line.tolist())


def _matrix(*numbers: float) -> str:
    return f"matrix({' '.join(f'{number:.7g}' for number in numbers)})"
