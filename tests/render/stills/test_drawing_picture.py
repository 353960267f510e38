"""Does the picture of a drawing show its parts and its faults, and is it written whole or not at all?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.render.drawing_picture import CIRCLED, COLOURS, FAULT, draw_drawing, picture

RING = (Loop((Arc(0, 0, 2e-3, 0, TURN),), "TEETH"), Loop((Arc(0, 0, 1e-3, 0, -TURN),), "TEETH", hole=True))
FAULTY = Finding("open-outline", "error", "open", "", "TEETH", 2.0, 0.0)


def drawing(**changes: object) -> Drawing:
    facts: dict[str, object] = {
        "path": Path("$wheel_1$.dxf"),
        "format": "dxf",
        "units": "mm",
        "units_from": "header",
        "loops": RING,
        "open_chains": (Loop((Line(0, 0, 1e-3, 3e-3),), "AXES", False),),
        "points": (("PIVOT", 0.0, 0.0),),
        "layers": ("TEETH", "AXES", "PIVOT"),
        "findings": (Finding("ignored", "notice", "text"), FAULTY),
    }
    return Drawing(**(facts | changes))  # type: ignore[arg-type]


def colour_of(text: str) -> tuple[int, ...]:
    return tuple(int(text[k : k + 2], 16) for k in (1, 3, 5))


def test_picture_file_shows_outline_and_fault(tmp_path: Path) -> None:
    from PIL import Image

    target = tmp_path / "import.png"
    draw_drawing(drawing(), target)
    pixels = np.asarray(Image.open(target).convert("RGB")).reshape(-1, 3)
    for colour in (COLOURS[0], COLOURS[1], FAULT):
        near = np.abs(pixels.astype(int) - colour_of(colour)).max(axis=1) < 12
        assert near.sum() > 50, colour
    assert [path.name for path in tmp_path.iterdir()] == ["import.png"]


def test_circles_carry_the_numbers_of_the_report() -> None:
    (axes,) = picture(drawing()).axes
    assert [text.get_text() for text in axes.texts] == ["2"]
    assert axes.get_aspect() == 1.0
    assert axes.get_title(loc="left").startswith("$wheel_1$.dxf   4 × 5 mm")


def test_findings_at_one_place_share_a_circle() -> None:
    (axes,) = picture(drawing(findings=(FAULTY,) * 5)).axes
    assert [text.get_text() for text in axes.texts] == ["1–5"]


def test_nothing_to_show_is_still_a_picture(tmp_path: Path) -> None:
    empty = drawing(loops=(), open_chains=(), points=(), layers=())
    draw_drawing(empty, tmp_path / "empty.png")
    assert "nothing to show" in picture(empty).axes[0].get_title(loc="left")


def test_a_folder_that_is_not_there_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(OSError):
        draw_drawing(drawing(), tmp_path / "none" / "import.png")
    assert not list(tmp_path.iterdir())


def test_centres_are_marked_on_request_only() -> None:
    def dots(centres: bool) -> int:
        (axes,) = picture(drawing(), centres).axes
        return sum(line.get_marker() == "o" for line in axes.lines)

    assert dots(True) == dots(False) + 1


def test_more_faults_than_circles_is_said() -> None:
    rows = 15
    many = tuple(
        Finding("x", "error", "x", "", "TEETH", -2 + 4 * (k % rows) / rows, -2 + 5 * (k // rows) / rows) for k in range(225)
    )
    figure = picture(drawing(findings=many))
    assert len(figure.axes[0].texts) == CIRCLED
    assert f"{225 - CIRCLED} more faults" in figure.axes[0].get_legend().get_title().get_text()


def disc(layer: str, radius: float, x: float = 0.0) -> Loop:
    return Loop((Arc(x, 0, radius, 0, TURN),), layer)


def test_a_bore_on_its_own_layer_is_empty_and_a_pivot_has_no_tint(tmp_path: Path) -> None:
    from PIL import Image

    parts = (disc("TEETH", 4e-3), disc("BORE", 1e-3, 2e-3), disc("PIVOT", 1e-3, -2e-3), disc("PIN", 0.5e-3, 1e-4))
    layers = tuple(loop.layer for loop in parts)
    figure = picture(drawing(loops=parts, open_chains=(), points=(), findings=(), layers=layers))
    figure.savefig(tmp_path / "bore.png", dpi=100)
    pixels = np.asarray(Image.open(tmp_path / "bore.png").convert("RGB"))

    def seen(x_mm: float, y_mm: float) -> tuple[int, ...]:
        x, y = figure.axes[0].transData.transform((x_mm, y_mm))
        return tuple(pixels[len(pixels) - 1 - round(y), round(x)].tolist())

    assert seen(2.3, 0.3) == (255, 255, 255)
    assert seen(-2.3, 0.3) == seen(0.3, 3.3) != (255, 255, 255)
    assert seen(0.3, 0.2) not in (seen(0.3, 3.3), (255, 255, 255))


def test_no_two_layers_look_alike() -> None:
    many = tuple(disc(f"L{k}", 1e-3, 3e-3 * k) for k in range(15))
    (axes,) = picture(drawing(loops=many, layers=tuple(loop.layer for loop in many), points=())).axes
    swatches = [(patch.get_facecolor(), patch.get_hatch()) for patch in axes.get_legend().get_patches()]
    assert len(swatches) == len(set(swatches)) == 15
