"""Does the picture of a drawing show its parts and its faults, and is it written whole or not at all?"""

import math
from dataclasses import replace
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from render.fake_runs import MM, circle, disc_run, polygon, watch_run, watch_scene

import watchsim as ws
from watchsim.cli import main
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.mechanism.check import modelled_pairs
from watchsim.mechanism.compile import compile_scene
from watchsim.model import LINE as LINE_of_still
from watchsim.render import stage as module
from watchsim.render.drawing_picture import (
    CIRCLED,
    COLOURS,
    FAULT,
    LINE,
    best_box,
    draw_drawing,
    in_ranges,
    label,
    picture,
    places,
    shared,
)
from watchsim.render.marks import ContactMarks
from watchsim.render.movie import frame
from watchsim.render.palette import BLUED, BRASS, FIXED, NIGHT, OTHERS, RUBY, STEEL, finish, looks
from watchsim.render.parts import hatching, is_round, parts, pose_matrix, signed_area
from watchsim.render.stage import Stage
from watchsim.render.view import MARGIN, Frame, placed, poses, view
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EVENT_DTYPE, EventKind

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


def test_a_folder_that_is_not_there_is_made(tmp_path: Path) -> None:
    draw_drawing(drawing(), tmp_path / "none" / "import.png")
    assert [path.name for path in (tmp_path / "none").iterdir()] == ["import.png"]


def test_a_folder_that_cannot_be_made_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "none").write_text("a file")
    with pytest.raises(OSError):
        draw_drawing(drawing(), tmp_path / "none" / "import.png")
    assert [path.name for path in tmp_path.iterdir()] == ["none"]


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


FRAME = np.array([0.0, 0.0, 500.0, 500.0])


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ([4], "4"),
        ([2, 1], "1, 2"),
        ([7, 8, 9, 3], "3, 7–9"),
        ([1, 3, 5, 7, 9, 11], "1, 3 … (in all 6)"),
        (list(range(1, 60)), "1–59"),
    ],
)
def test_numbers_in_ranges(numbers: list[int], text: str) -> None:
    assert in_ranges(numbers) == text


def test_faults_a_hair_apart_share_a_circle_and_none_is_forgotten() -> None:
    points = [(k, np.array([10.0 * (k % 20) + 0.1 * (k % 3), 10.0 * (k // 20)])) for k in range(300)]
    circles, left = shared([*points, (300, np.array([0.5, 0.5]))])
    assert len(circles) == CIRCLED
    assert sum(len(numbers) for _, numbers in circles) + left == 301
    assert [0, 300] in [numbers for _, numbers in circles]


def test_numbers_avoid_each_other_where_there_is_room() -> None:
    taken: list[tuple[float, float, float, float]] = [(250.0, 250.0, 263.0, 263.0)]
    for _ in range(12):
        box, _ = best_box(np.array([256.5, 256.5]), 12.0, np.array(taken), FRAME)
        for other in taken:
            wide, high = min(box[2], other[2]) - max(box[0], other[0]), min(box[3], other[3]) - max(box[1], other[1])
            assert max(wide, 0.0) * max(high, 0.0) < 0.1 * 12.0 * LINE
        taken.append(box)


def test_numbers_stay_in_the_picture() -> None:
    box, _ = best_box(np.array([499.0, 499.0]), 30.0, np.array([(493.0, 493.0, 505.0, 505.0)]), FRAME)
    assert box[2] <= 500.0 and box[3] <= 500.0 and box[3] - box[1] == LINE


def test_long_numbers_are_shortened_only_where_they_would_cover_others() -> None:
    centre, numbers = np.array([250.0, 250.0]), [5, 9, 14, 20]
    ring = (243.5, 243.5, 256.5, 256.5)
    assert label(centre, numbers, np.array([ring]), FRAME)[1] == "5, 9 … (in all 4)"
    # Stripes leave free columns too narrow for all of the numbers.
    stripes = [(x, 0.0, x + 1.0, 500.0) for x in np.arange(0.0, 500.0, 40.0)]
    box, text = label(centre, numbers, np.array([ring, *stripes]), FRAME)
    assert text == "5 +3" and not any(box[0] < high and low < box[2] for low, _, high, _ in stripes)
    assert label(centre, [5], np.array([ring, *stripes]), FRAME)[1] == "5"


def test_both_ends_of_a_gap_are_circled(tmp_path: Path) -> None:
    page = tmp_path / "open.svg"
    path = '<path fill="none" stroke="black" d="M 1,1 H 9 V 9 H 1 V 3"/>'
    size = 'width="10mm" height="10mm" viewBox="0 0 10 10"'
    page.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{path}</svg>')
    (gap,) = [finding for finding in read(page).findings if finding.code == "open-outline"]
    (first, second) = places(gap)
    assert np.hypot(first[0] - second[0], first[1] - second[1]) == pytest.approx(2.0) and first[0] == pytest.approx(second[0])
    assert places(Finding("units", "error", "nowhere")) == []
    assert shared([(1, np.zeros(2)), (1, np.array([30.0, 0.0])), (2, np.zeros(2)), (2, np.ones(2))])[1] == 0
    assert [numbers for _, numbers in shared([(1, np.zeros(2)), (1, np.ones(2))])[0]] == [[1]]


LEVER = Path(__file__).resolve().parents[2] / "profiles" / "bench_lever" / "scene.toml"


def test_reachable_edges_wear_colour_and_others_do_not(tmp_path):
    scene = ws.load(LEVER)
    compiled = compile_scene(scene)
    pairs = modelled_pairs(compiled, [body.name for body in scene.bodies])
    module.still(scene, tmp_path / "start.png", compiled, pairs)
    picture = imageio.imread(tmp_path / "start.png").astype(float) / 255.0
    view = Stage(module.at_rest(scene, compiled), module.STILL_SIZE, (0.0, 1.0)).view
    rows = {"never": [], "reachable": [], "candidate": []}
    for number, body in enumerate(scene.bodies):
        matrix = view.matrix(view.centre) @ pose_matrix(np.array([*body.position, body.angle]))
        for i, primitive in enumerate(compiled.model.primitives):
            if primitive.body != number or primitive.kind != LINE_of_still or primitive.length < 0.2e-3:
                continue
            middle = (primitive.x + 0.5 * primitive.length * primitive.tx, primitive.y + 0.5 * primitive.length * primitive.ty)
            x, y, _ = matrix @ (*middle, 1.0)
            kind = "candidate" if i in pairs.candidates else "reachable" if i in pairs.reachable else "never"
            rows[kind].append(picture[module.STILL_SIZE[1] - 1 - round(y), round(x)])
    wanted = {"reachable": module.REACHABLE, "candidate": module.CANDIDATE}
    for kind, colour in wanted.items():
        off = np.abs(np.array(rows[kind]) - to_rgb(colour)).max(axis=1)
        # Bodies that touch cover each other's edges here and there.
        assert len(off) > 3 and np.mean(off < 0.35) > 0.9, kind
    for colour in wanted.values():
        assert np.abs(np.array(rows["never"]) - to_rgb(colour)).max(axis=1).min() > 0.3


def shapes(*loops, motion="pivot", decoration=()):
    return parts(Scene("", (Body("wheel", motion, loops=loops, decoration=decoration),)), 1e-8, 1e-3)


def test_arcs_are_as_round_as_asked():
    (part,) = shapes(circle(0, 0, 2, "A"))
    radii = np.hypot(*part.faces.vertices.T)
    middles = np.hypot(*(0.5 * (part.faces.vertices[1:] + part.faces.vertices[:-1])).T)
    assert radii == pytest.approx(2 * MM, abs=1e-12)
    assert 2 * MM - middles.min() <= 1e-8


def test_a_hole_is_empty_even_on_a_layer_of_its_own_or_wrongly_oriented():
    wrong = circle(0, 0, 1, "BORE", hole=True)
    for hole in (circle(0, 0, 1, "A", hole=True), wrong, type(wrong)(wrong.reversed().edges, "BORE", True, True)):
        (part,) = shapes(circle(0, 0, 2, "A"), hole)
        assert part.area == pytest.approx(math.pi * 4 * MM**2, rel=1e-4)
        total = sum(signed_area(ring) for ring in part.faces.to_polygons(closed_only=True))
        assert total == pytest.approx(math.pi * 3 * MM**2, rel=1e-4)


def test_a_layer_named_for_bores_empties_the_wheel_and_a_pivot_is_not_drawn():
    (part,) = shapes(circle(0, 0, 2, "TEETH"), decoration=(circle(0, 0, 1, "Wheel bore"), circle(0, 0, 0.5, "PIVOT")))
    total = sum(signed_area(ring) for ring in part.faces.to_polygons(closed_only=True))
    assert total == pytest.approx(math.pi * 3 * MM**2, rel=1e-4)


def test_a_hole_goes_to_the_smallest_outline_around_it():
    found = shapes(circle(0, 0, 5, "BIG"), circle(0, 0, 2, "SMALL"), circle(0, 0, 1, "BORE", hole=True))
    rings = [len(part.faces.to_polygons()) for part in found]
    assert rings == [1, 2]


def test_a_slot_on_the_border_is_empty_and_what_fills_a_hole_is_not():
    plate, slot = polygon([(0, 0), (4, 0), (4, 2), (0, 2)], "A"), polygon([(1, 0), (2, 0), (2, 1), (1, 1)], "SLOT")
    (part,) = shapes(plate, decoration=(type(slot)(slot.reversed().edges, "SLOT", True, True),))
    assert not part.ground and len(part.faces.to_polygons()) == 2
    found = shapes(circle(0, 0, 2, "A"), circle(0, 0, 1, "A", hole=True), circle(0, 0, 1, "STONE"))
    assert [len(part.faces.to_polygons()) for part in found] == [2, 1]


def test_small_parts_lie_on_top_and_decoration_is_drawn():
    found = shapes(circle(0, 0, 1, "A"), circle(0, 0, 0.2, "C"), decoration=(circle(0, 0, 3, "B"),))
    assert [part.area for part in found] == sorted((part.area for part in found), reverse=True)
    assert len(found) == 3


def test_what_can_touch_lies_on_the_same_shape_of_another_section() -> None:
    one, again = circle(0, 0, 1, "PALLET"), circle(1e-9, 0, 1.00000001, "SECTION")
    for loops, decoration in (((one,), (again,)), ((again,), (one,))):
        body = Body("lever", loops=loops, decoration=decoration)
        assert [part.layer for part in parts(Scene("t", (body,)), 1e-6, 1e-3)] == [decoration[0].layer, loops[0].layer]


def test_open_outlines_are_ground_hatched_on_the_left():
    (part,) = shapes(polygon([(10, 0), (0, 0)], "line", closed=False), motion="fixed")
    assert part.ground
    assert part.strokes.vertices[:, 1].max() <= 1e-15  # travelling towards -x the left is below
    assert part.strokes.vertices[:, 1].min() < -0.5e-3
    assert len(hatching(np.array([[0.0, 0.0], [1.0, 0.0]]), 0.1).vertices) == 20


def test_only_circles_about_the_origin_hide_their_turning():
    assert is_round(Body("disc", loops=(circle(0, 0, 5, "A"),)))
    assert not is_round(Body("disc", loops=(circle(0, 1, 5, "A"),)))
    assert not is_round(Body("disc", loops=(polygon([(0, 0), (1, 0), (0, 1)], "A"),)))
    assert not is_round(Body("disc"))


def test_watch_colours():
    scene = watch_scene()
    _, lever, balance, _ = scene.bodies
    worn = looks(scene)
    assert worn == {"wheel": BRASS, "lever": STEEL, "balance": BLUED, "banking": FIXED}
    assert finish(lever, "STONES", STEEL) is RUBY and finish(lever, "ARMS", STEEL) is STEEL
    assert finish(lever, "PALLET_FORK", STEEL) is STEEL
    assert finish(balance, "ROLLER", BLUED) is BLUED and finish(balance, "PIN", BLUED) is RUBY
    assert finish(balance, "SAFETY", BLUED) is NIGHT
    for name, look in {"pallet_fork": STEEL, "balance_wheel": BLUED, "escape_wheel": BRASS}.items():
        assert looks(Scene("", (Body(name),))) == {name: look}
    assert looks(Scene("", (Body("plane", "fixed"),))) == {"plane": FIXED}
    assert looks(Scene("", (Body("balance", loops=(circle(0, 0, 1, "PIN"),)),))) == {"balance": RUBY}


def test_what_is_only_drawn_is_pale_and_no_stone_because_of_others() -> None:
    drawn = (circle(0, 0, 9, "BOB"), circle(0, 0, 3, "ROD"), circle(0, 5, 1, "JEWELS"), circle(0, 0, 2, "PALLETS"))
    pendulum = Body("pendulum", loops=(circle(0, 1, 1, "PALLETS"),), decoration=drawn)
    look = looks(Scene("", (pendulum,)))["pendulum"]
    assert look is RUBY and finish(pendulum, "PALLETS", look) is RUBY
    fills = {layer: finish(pendulum, layer, look) for layer in ("BOB", "ROD", "JEWELS")}
    assert all(one.pale for one in fills.values())
    assert [one.fill for one in fills.values()] == [BRASS.fill, STEEL.fill, RUBY.fill]


def test_no_two_moving_bodies_look_alike():
    """Words come first: a carriage named before the lever leaves it its steel."""
    names = ("carriage", "wheel", "lever", "balance", "click", "third_wheel", "cam")
    worn = looks(Scene("", tuple(Body(name) for name in names)))
    assert worn["lever"] is STEEL and worn["wheel"] is BRASS and worn["balance"] is BLUED
    assert len(set(worn.values())) == len({look.line for look in worn.values()}) == len(names)
    many = tuple(Body(f"part {k}") for k in range(20))
    assert set(looks(Scene("", many)).values()) == set(OTHERS)


FRAME_VIEW = Frame(0.0, 50.0, 1280.0, 600.0)


def seen(the_view, frames, points):
    """Pixels of points in metres."""
    matrix = the_view.matrix(the_view.centre_at(frames))
    return points @ matrix[:2, :2].T + matrix[:2, 2]


def test_a_flat_mechanism_is_turned_where_that_enlarges_it():
    run = watch_run()
    turned = view(run, (0.0, 2.0), FRAME_VIEW, None, None)
    upright = view(run, (0.0, 2.0), FRAME_VIEW, None, 0.0)
    assert turned.turn == pytest.approx(-math.pi / 2)
    # 10 mm from the foot of the wheel to the top of the roller, 4 mm across
    assert upright.scale == pytest.approx(600 * (1 - 2 * MARGIN) / (10 * MM), rel=1e-3)
    assert turned.scale > 1.25 * upright.scale
    tall = view(run, (0.0, 2.0), Frame(0, 0, 600, 1280), None, None)
    assert tall.turn == 0.0


def test_gravity_points_down():
    run = watch_run(gravity=(9.81, 0.0))
    shown = view(run, (0.0, 2.0), FRAME_VIEW, None, None)
    down = shown.matrix(shown.centre)[:2, :2] @ np.array([1.0, 0.0])
    assert down / np.hypot(*down) == pytest.approx((0.0, -1.0), rel=1e-12, abs=1e-15)


def test_everything_stays_inside_at_equal_scales():
    run = watch_run()
    shown = view(run, (0.0, 2.0), FRAME_VIEW, None, None)
    for t in np.linspace(0.0, 2.0, 37):
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        pin = placed(np.array([[0.0, -0.85 * MM]]), frames["balance"][None])[0]
        x, y = seen(shown, frames, pin)[0]
        assert 0 <= x <= 1280 and 50 <= y <= 650
    matrix = shown.matrix(shown.centre)[:2, :2]
    assert matrix @ matrix.T == pytest.approx(shown.scale**2 * np.eye(2), rel=1e-12, abs=1e-6)


def test_a_pivoted_body_takes_only_the_room_it_sweeps():
    hand = Body("hand", "pivot", loops=(polygon([(0, 0), (10, 0), (10, 1), (0, 1)], "A"),))
    run = watch_run()
    run = replace(run, scene=replace(run.scene, bodies=(hand,)), slices={"hand": slice(1, 2)})
    narrow = view(run, (0.0, 0.9), FRAME_VIEW, None, 0.0)  # swings by 0.1 rad only
    high = 10 * MM * math.sin(0.1) + 1 * MM * math.cos(0.1)
    low = -10 * MM * math.sin(0.1)
    assert narrow.centre[1] == pytest.approx(0.5 * (low + high), rel=1e-2)


def test_zoom_frames_the_named_bodies():
    run = watch_run()
    near = view(run, (0.0, 2.0), FRAME_VIEW, ["balance"], None)
    assert near.centre == pytest.approx((0.0, 7 * MM), abs=1e-6)
    assert near.scale == pytest.approx(600 * (1 - 2 * MARGIN) / (2 * MM), rel=1e-3)
    with pytest.raises(ValueError, match="'ballance'; there are: wheel, lever, balance, banking"):
        view(run, (0.0, 2.0), FRAME_VIEW, ["ballance"], None)


def test_a_far_traveller_is_followed_along_its_way():
    run = disc_run()
    shown = view(run, (0.0, 3.0), FRAME_VIEW, None, None)
    assert shown.follow == "disc"
    for t in (0.0, 1.0, 3.0):
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        x, y = seen(shown, frames, frames["disc"][None, :2])[0]
        assert x == pytest.approx(640, abs=1) and y == pytest.approx(350, abs=1)
    assert view(run, (0.0, 0.1), FRAME_VIEW, None, None).follow is None


def test_a_scene_without_outlines_cannot_be_drawn():
    run = watch_run(bodies=(Body("wheel"), Body("lever"), Body("balance")))
    with pytest.raises(ValueError, match="no body of this scene has an outline"):
        view(run, (0.0, 2.0), FRAME_VIEW, None, None)


def test_ground_near_the_bodies_is_brought_into_sight():
    """A disc of 50 mm stands still, 1 mm above a plane that reaches 20 m to the right, or a hundred sizes above it."""
    run = disc_run()
    for height, near in ((0.06, True), (10.0, False)):
        at_rest = replace(run, q=np.tile([0.3, height, 0.0], (len(run.t), 1)), u=0.0 * run.u, a=0.0 * run.a)
        shown = view(at_rest, (0.0, 3.0), FRAME_VIEW, None, 0.0)
        below = seen(shown, {}, np.array([[0.3, -1e-3]]))[0]
        assert (FRAME_VIEW.bottom < below[1] < FRAME_VIEW.bottom + FRAME_VIEW.height) == near
        left, right = seen(shown, {}, np.array([[0.25, height], [0.35, height]]))[:, 0]
        assert FRAME_VIEW.left < left < right < FRAME_VIEW.left + FRAME_VIEW.width


def with_contact(run, bodies, moments):
    """The run with one declared contact and events (t, kind) of its contact number 0."""
    contact = Contact((Side(bodies[0]), Side(bodies[1])), 0.3)
    events = np.array([(t, kind, 0, -1, 0.0, 0.0, 0.0, 0.0) for t, kind in moments], dtype=EVENT_DTYPE)
    return replace(run, scene=replace(run.scene, contacts=(contact,)), events=events)


def points(run, t):
    frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    return ContactMarks(run).points(t, frames)


def test_a_rolling_disc_touches_below_its_centre_while_closed():
    run = with_contact(disc_run(), ("disc", "plane"), [(0.5, EventKind.CLOSE), (2.0, EventKind.OPEN)])
    assert len(points(run, 0.4)) == 0
    x = run.at(1.0)[0][0]
    assert points(run, 1.0) == pytest.approx(np.array([[x, 0.0]]), abs=1e-12)
    assert len(points(run, 2.0)) == 0


def test_two_circles_touch_between_their_centres():
    left = Body("left", "free", (0.0, 0.0), mass=1.0, inertia=1.0, loops=(circle(0, 0, 2, "A"),))
    right = Body("right", "fixed", (5 * MM, 0.0), loops=(circle(0, 0, 3, "A"),))
    run = disc_run()
    still = replace(
        run, scene=Scene("", (left, right)), q=0.0 * run.q, u=0.0 * run.u, a=0.0 * run.a, slices={"left": slice(0, 3)}
    )
    marked = with_contact(still, ("left", "right"), [(0.0, EventKind.CLOSE)])
    assert len(compile_scene(marked.scene).model.contacts) == 1
    assert points(marked, 1.0) == pytest.approx(np.array([[2 * MM, 0.0]]), abs=1e-12)


def test_marks_are_drawn_only_when_asked_for():
    run = with_contact(disc_run(), ("disc", "plane"), [(0.5, EventKind.CLOSE)])
    plain, marked = frame(run, 1.0, (480, 270)), frame(run, 1.0, (480, 270), contacts=True)
    assert not np.array_equal(plain, marked)
    assert np.array_equal(frame(run, 0.2, (480, 270)), frame(run, 0.2, (480, 270), contacts=True))


def test_events_of_another_scene_are_refused():
    run = disc_run()
    events = np.array([(0.5, EventKind.CLOSE, 7, -1, 0.0, 0.0, 0.0, 0.0)], dtype=EVENT_DTYPE)
    with pytest.raises(ValueError, match="do not belong to its scene"):
        ContactMarks(replace(run, events=events))


def test_texts_as_long_as_a_file_do_not_make_a_picture_large(tmp_path: Path) -> None:
    """100 kB of an entity in names and words of a drawing, lines of it too, are cut in the picture."""
    head = 'xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9"'
    entity = f'<!DOCTYPE svg [<!ENTITY long "{20_000 * "w$_^x"}">]>'
    layers = "".join(f'<g id="{k}&#10;&long;"><path d="M1 {k}h3v.5"/><text>&long;</text></g>' for k in range(3))
    sizes = []
    short = f"<svg {head}>{layers.replace('&long;', 24 * 'w')}</svg>"
    for name, text in (("a.svg", short), (f"{120 * 'n'}.svg", f"{entity}<svg {head}>{layers}</svg>")):
        (tmp_path / name).write_text(text)
        assert main(["inspect", str(tmp_path / name), "--png", str(tmp_path / "out.png")]) == 0
        sizes.append(imageio.imread(tmp_path / "out.png").shape[:2])
    assert sizes[1][1] <= 1.2 * sizes[0][1] and sizes[1][0] <= 1.1 * sizes[0][0]
