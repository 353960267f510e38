"""Does the page show in a browser what the run says, without an error, a request, or a barrier?"""

import base64
import io
import itertools
import json
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import imageio.v3 as iio
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.path import Path as ClosedPath
from pages.browser import opened
from pages.pace import played
from render.colour_vision import TO_XYZ, lab, linear
from scipy.ndimage import maximum_filter, minimum_filter
from shapely.affinity import affine_transform
from shapely.geometry import LineString, Point, Polygon
from shapely.ops import unary_union

from watchsim.analysis.forces import forces
from watchsim.analysis.sound import BLOW
from watchsim.analysis.timeline import shown_beats
from watchsim.geometry.loops import polyline
from watchsim.pages.charts import WIDTH
from watchsim.pages.compare_page import comparison_page
from watchsim.pages.player import drawn_parts
from watchsim.pages.report_page import page_text, report
from watchsim.pages.tolerance_page import tolerance_page
from watchsim.paths import profiles_dir
from watchsim.render.movie import frame
from watchsim.render.palette import BLUED, BRASS, FIXED, NIGHT, RUBY, STEEL
from watchsim.render.part_names import part_names
from watchsim.render.parts import loops_of
from watchsim.render.stage import Stage
from watchsim.render.view import hairsprings, poses, zigzags
from watchsim.scene.forces import LineSpring
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory
from watchsim.studies.compare import compare, side_of
from watchsim.studies.tolerance import tolerance

pytestmark = pytest.mark.slow
SIZE = (1280, 720)
FINISHES = (BRASS, STEEL, RUBY, FIXED, BLUED, NIGHT)
BEATS_MB = 1.0
PARTS = {"FORK": "fork", "PIN": "roller jewel", "ARMS": "lever", "PINS": "banking", "TEETH": "wheel"}


@pytest.fixture(scope="module")
def run() -> Trajectory:
    return simulate(load(Path(str(profiles_dir())) / "swiss_lever" / "scene.toml"), duration=2.0)


@pytest.fixture(scope="module")
def written(run: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return report(run, tmp_path_factory.mktemp("page") / "watch.html")


def filled(picture: Any, colour: str, mixed: float = 2.0) -> Any:
    """Where a picture shows that colour, each channel off by no more than `mixed`."""
    wanted = np.round(255.0 * np.array(to_rgb(colour)))
    return np.all(np.abs(picture[..., :3].astype(float) - wanted) <= mixed, axis=-1)


def strays(one: Any, other: Any, colour: str) -> int:
    """Pixels of that colour in one picture that are more than a pixel away from any in the other, where edges may mix it."""
    return int(np.sum(filled(one, colour) & ~maximum_filter(filled(other, colour, 60.0), size=3)))


def enlarged(page: Any) -> None:
    page.add_style_tag(
        content=f"#picture {{ position: fixed; inset: 0; width: {SIZE[0]}px; height: {SIZE[1]}px; border: 0; z-index: 9 }}"
    )
    page.wait_for_timeout(200)


def seconds_of_loading(page: Any) -> float:
    """What loading takes of a processor, whatever else the machine does meanwhile."""
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})

    def spent() -> float:
        return next(one["value"] for one in session.send("Performance.getMetrics")["metrics"] if one["name"] == "TaskDuration")

    before = spent()
    page.reload()
    while not page.text_content("#time"):  # the first frame has been drawn
        page.wait_for_timeout(10)
    after = spent()
    return after - before if after >= before else after


def test_ten_beats_are_under_a_megabyte(written: Path) -> None:
    assert written.stat().st_size < BEATS_MB * 1e6


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (768, "dark"), (360, "dark")])
def test_it_opens_at_once_in_silence_and_fits(written: Path, width: int, scheme: str) -> None:
    with opened(written, width, 740, scheme) as page:
        loaded = seconds_of_loading(page)
        page.keyboard.press("Space")
        page.wait_for_timeout(500)
        assert page.said == []
        assert loaded < 1.0
        assert set(page.asked) == {written.absolute().as_uri()}
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate("document.documentElement.dataset.theme") == scheme


def test_outlines_are_where_the_run_and_its_movie_have_them(run: Trajectory, written: Path) -> None:
    end = float(run.t[-1])
    window = (end - 1.25, end)
    stage = Stage(run, SIZE, window)
    times = np.concatenate((np.linspace(*window, 14), run.events["t"][-6:]))
    view = stage.view
    with opened(written) as page:
        enlarged(page)
        for t in times.tolist():
            page.evaluate("t => watchsim.seek(t)", t)
            frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
            page.evaluate("([c, s, a]) => watchsim.look(c, s, a)", [list(view.centre), view.scale, view.turn])
            matrix = view.matrix(view.centre_at(frames))
            middle = np.array(view.middle) - np.array(SIZE) / 2.0  # the movie keeps bands free at top and bottom
            for body in run.scene.bodies:
                points = np.concatenate([polyline(loop, 1e-6) for loop in loops_of(body)])
                x, y, angle = frames[body.name]
                c, s = np.cos(angle), np.sin(angle)
                placed = np.stack((x + c * points[:, 0] - s * points[:, 1], y + s * points[:, 0] + c * points[:, 1]), axis=1)
                expected = placed @ matrix[:2, :2].T + matrix[:2, 2] - middle
                expected[:, 1] = SIZE[1] - expected[:, 1]
                seen = np.array(page.evaluate("([name, points]) => watchsim.seen(name, points)", [body.name, points.tolist()]))
                assert np.abs(seen - expected).max() < 0.02, (t, body.name)


def test_pixels_agree_with_the_frames_of_a_movie(run: Trajectory, written: Path) -> None:
    end = float(run.t[-1])
    window = (end - 1.25, end)
    view = Stage(run, SIZE, window).view
    down = round(SIZE[1] / 2.0 - view.middle[1])
    with opened(written) as page:
        enlarged(page)
        page.evaluate("watchsim.mark(false, false)")
        for t in np.linspace(*window, 20).tolist():
            # The movie's middle stands off that of the picture by whole and half pixels.
            shift = np.array(SIZE) / 2.0 - np.array(view.middle)
            c, s = np.cos(view.turn), np.sin(view.turn)
            dx, dy = shift[0] / view.scale, (shift[1] - down) / view.scale
            centre = [view.centre[0] + c * dx + s * dy, view.centre[1] - s * dx + c * dy]
            page.evaluate("([c, s, a]) => watchsim.look(c, s, a)", [centre, view.scale, view.turn])
            page.evaluate("t => watchsim.seek(t)", t)
            shown = page.evaluate("document.getElementById('stage').toDataURL('image/png')")
            drawn = iio.imread(io.BytesIO(base64.b64decode(shown.split(",", 1)[1])))
            # Both without the bands of the movie: its words would hide parts, the page's would not.
            movie = frame(run, t, SIZE, window)
            assert drawn.shape[:2] == movie.shape[:2]
            moved = np.roll(drawn, down, axis=0)
            rows = slice(80, 640)
            for finish in FINISHES:
                ours, theirs = moved[rows], movie[rows]
                assert filled(theirs, finish.fill).sum() > 0
                assert strays(ours, theirs, finish.fill) == 0 and strays(theirs, ours, finish.fill) == 0, (t, finish)


def test_a_hairspring_lies_where_movies_draw_it(run: Trajectory, written: Path) -> None:
    (spring,) = hairsprings(run.scene)
    with opened(written) as page:
        for t in np.linspace(*page.evaluate("watchsim.window"), 20).tolist():
            page.evaluate("t => watchsim.seek(t)", t)
            ((*numbers,),) = (map(float, one[1:].split()) for one in page.evaluate("watchsim.coils()"))
            seen = 1e-3 * np.array(numbers).reshape(-1, 2)
            frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
            assert np.abs(seen - spring.line(frames, len(seen) - 1)).max() < 1e-7


def test_a_spring_between_points_lies_where_movies_draw_it(run: Trajectory, tmp_path: Path) -> None:
    hooked = LineSpring(("lever", "balance"), ((1e-4, 2e-4), (3e-4, 0.0)), stiffness=1.0, length=1e-3)
    hung = replace(run, scene=replace(run.scene, line_springs=(hooked,)))
    (spring,) = zigzags(hung.scene)
    path = tmp_path / "hung.html"
    path.write_text(page_text(hung), encoding="utf-8")
    with opened(path) as page:
        for t in np.linspace(*page.evaluate("watchsim.window"), 20).tolist():
            page.evaluate("t => watchsim.seek(t)", t)
            (text,) = page.evaluate("watchsim.zigzags()")
            seen = 1e-3 * np.array([float(number) for number in text[1:].split()]).reshape(-1, 2)
            frames = {name: rows[0] for name, rows in poses(hung, np.array([t])).items()}
            assert np.abs(seen - spring.line(frames)).max() < 1e-7
        assert page.said == []


def test_a_rim_is_drawn_faintly_and_chosen_with_its_balance(run: Trajectory, written: Path) -> None:
    rim = next(loop for loop in run.scene.body("balance").decoration if loop.layer == "RIM" and not loop.hole)
    edge = rim.edges[0]
    inside = [[0.94 * edge.radius, 0.0]]
    with opened(written) as page:
        ((x, y),) = page.evaluate("([name, points]) => watchsim.seen(name, points)", ["balance", inside])
        assert "RIM" in [part["layer"] for part in page.evaluate("watchsim.parts()") if part["pale"]]
        page.click("#stage", position={"x": x, "y": y})
        page.wait_for_timeout(100)
        assert page.text_content("#release").startswith("Following balance")


def test_values_and_forces_are_those_of_the_run(run: Trajectory, written: Path) -> None:
    end = float(run.t[-1])
    times = np.sort(np.random.default_rng(5).uniform(end - 1.25, end, 60))
    q, u = run.sample(times)
    own = run.slices["balance"].start
    told = forces(run, times)
    with opened(written) as page:
        angle, velocity, moment = (
            np.array(page.evaluate("([k, ts]) => ts.map((t) => watchsim.value(k, t))", [k, times.tolist()])) for k in range(3)
        )
        closed = page.evaluate("ts => ts.map((t) => watchsim.closed(t))", times.tolist())
    assert np.abs(angle - np.degrees(q[:, own])).max() < 3e-4
    assert np.abs(velocity - np.degrees(u[:, own])).max() < 2e-4 * np.degrees(np.abs(u[:, own]).max())
    pivot = np.array(run.scene.body("balance").position)
    expected = np.zeros(len(times))
    for i in range(len(times)):
        held = {
            run.pairs[int(k)]: (told.normal[i, j], told.point[i, j], told.direction[i, j], told.tangential[i, j])
            for j, k in enumerate(told.pairs)
            if np.isfinite(told.point[i, j, 0])
        }
        assert len(closed[i]) == len(held), times[i]
        sizes = sorted(one["force"][0] for one in closed[i])
        assert np.allclose(sizes, sorted(float(value[0]) for value in held.values()), atol=0.004 * told.normal.max())
        for pair, (normal, point, direction, tangential) in held.items():
            if "balance" not in (pair.body_a, pair.body_b):
                continue
            force = normal * direction + tangential * np.array([-direction[1], direction[0]])
            force = force if pair.body_a == "balance" else -force
            arm = point - pivot
            expected[i] += arm[0] * force[1] - arm[1] * force[0]
    assert np.abs(moment - expected).max() < 0.01 * np.abs(moment).max() + 1e-12


def test_between_impacts_the_net_torque_is_that_of_the_motion(run: Trajectory, written: Path) -> None:
    """Also where a jump of the speed is too small to have rows of its own: the slope of the speed would show a torque."""
    unlocks = [one for one in shown_beats(run, rubbed=False)[-2].stages if one.name in ("unlock", "catch-up")]
    times = np.linspace(unlocks[0].phase.start - 1e-4, unlocks[-1].phase.end, 400)
    column, inertia = run.slices["balance"].start, run.scene.body("balance").inertia
    expected = inertia * run.acceleration(times)[:, column]
    with opened(written) as page:
        shown = np.array(page.evaluate("ts => ts.map((t) => watchsim.value(3, t))", times.tolist()))
    off = np.abs(shown - expected)
    assert np.quantile(off, 0.98) < 0.003 * np.abs(expected).max()


@pytest.fixture(scope="module")
def clock(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = simulate(load(Path(str(profiles_dir())) / "graham" / "scene.toml"), duration=6.0)
    return report(made, tmp_path_factory.mktemp("clock") / "clock.html")


CURVES_AND_DOTS = """() => [...document.querySelectorAll("#plots .plot")].map((plot) => {
  const canvas = plot.querySelector("canvas"), box = canvas.getBoundingClientRect();
  const dots = [...plot.querySelectorAll(".dot")].map((dot) => {
    const at = dot.getBoundingClientRect();
    return [at.x + at.width / 2 - box.x, at.y + at.height / 2 - box.y, getComputedStyle(dot).backgroundColor];
  });
  return { title: plot.querySelector("b").textContent, shown: canvas.toDataURL(), font: canvas.getContext("2d").font, dots };
})"""


@pytest.mark.parametrize("made", ["written", "clock"])
def test_dots_lie_on_their_curves_at_any_time_and_zoom(made: str, request: pytest.FixtureRequest) -> None:
    """By the pixels that were drawn, as a reader clicks; on a sharp screen, where letters are as large as on any other."""
    ratio, off, random = 2.0, [], np.random.default_rng(5)
    with opened(request.getfixturevalue(made), ratio=ratio) as page:
        for body in range(page.locator("#whose option").count()):
            page.select_option("#whose", index=body)
            for turns in (0, 2, 4):
                page.locator("#plots .field").first.hover()
                for _ in range(turns):
                    page.mouse.wheel(0, -500)
                page.wait_for_timeout(100)
                if page.locator("#plots .u-over").count() == 0:
                    continue
                box = page.locator("#plots .u-over").first.bounding_box()
                for share in random.uniform(0.0, 1.0, 8).tolist():
                    page.mouse.click(box["x"] + share * box["width"], box["y"] + 0.5 * box["height"])
                    page.wait_for_timeout(60)
                    for plot in page.evaluate(CURVES_AND_DOTS):
                        assert plot["font"].startswith(f"{12 * ratio:g}px")
                        drawn = iio.imread(io.BytesIO(base64.b64decode(plot["shown"].split(",", 1)[1]))).astype(float)
                        for x, y, colour in plot["dots"]:
                            wanted = [float(part) for part in colour[4:-1].split(",")]
                            rows, columns = np.nonzero(
                                np.all(np.abs(drawn[..., :3] - wanted) < 60.0, axis=-1) & (drawn[..., 3] > 120)
                            )
                            off.append(np.hypot(columns + 0.5 - ratio * x, rows + 0.5 - ratio * y).min() / ratio)
    assert len(off) > 100 and max(off) < 1.0


def test_keys_play_step_zoom_and_fade(written: Path) -> None:
    with opened(written) as page:
        now = lambda: page.text_content("#time")  # noqa: E731
        other = (
            "before => document.querySelector('#time').textContent !== before"  # what a key does is drawn with the next frame
        )
        page.focus("#stage")
        before = now()
        page.keyboard.press(".")
        stepped = now()
        assert stepped != before or page.text_content("#said")
        page.keyboard.press("Space")
        page.wait_for_timeout(300)
        page.keyboard.press("Space")
        assert now() != stepped
        played = now()
        page.keyboard.press("Home")
        page.wait_for_function(other, arg=played)
        first = now()
        page.keyboard.press("Shift+ArrowRight")
        page.wait_for_function(other, arg=first)
        page.keyboard.press("n")
        page.keyboard.press("x")
        page.wait_for_selector('#parts button:first-child[aria-pressed="true"]')  # with the next frame
        assert page.is_visible("#release")
        page.keyboard.press("Escape")
        page.keyboard.press("t")
        page.keyboard.press("f")
        page.wait_for_selector('#push[aria-pressed="true"]')
        assert page.evaluate("document.documentElement.dataset.theme") == "dark"
        assert page.said == []


def test_stepping_events_reads_as_many_times_and_names_what_is_heard(run: Trajectory, written: Path) -> None:
    start = float(run.t[-1]) - 0.3
    times = np.unique(run.events["t"][(run.events["t"] > start) & (run.events["kind"] != EventKind.HANDOVER)])[:20]
    with opened(written) as page:
        page.evaluate("t => watchsim.seek(t)", start)
        page.focus("#stage")
        seen, noises = [], 0
        for t in times.tolist():
            page.keyboard.press(".")
            page.wait_for_timeout(60)
            seen.append(page.text_content("#time"))
            assert abs(float(seen[-1].replace("\u202f", "").removesuffix(" s")) - t) < 1e-3
            here = run.events[(run.events["t"] == t) & (run.events["kind"] == EventKind.IMPACT)]
            if len(here):  # the strip names one of the pairs that met in this blow
                noises += 1
                named = page.text_content("#plots + .plot p span")
                blow = (run.events["t"] <= t) & (run.events["t"] >= t - BLOW) & (run.events["kind"] == EventKind.IMPACT)
                pairs = [run.pairs[k] for k in run.events["contact"][blow].tolist()]
                met = [{PARTS.get(layer, "stone") for layer in (p.layer_a, p.layer_b)} for p in pairs]
                assert not named or {name.split()[-1] if "stone" in name else name for name in named.split(" / ")} in met
            dot, line = (page.locator(f".plot {which}").first.bounding_box() for which in (".dot", ".u-cursor-x"))
            assert abs(dot["x"] + 0.5 * dot["width"] - line["x"]) < 2.0
        assert len(set(seen)) == len(times) and noises > 3


def test_a_click_follows_a_part(run: Trajectory, written: Path) -> None:
    with opened(written) as page:
        body = run.scene.body("lever")
        stone = next(loop for loop in body.loops if loop.layer == "STONES")
        inside = polyline(stone, 1e-5)[:-1].mean(axis=0)
        ((x, y),) = page.evaluate("([name, points]) => watchsim.seen(name, points)", ["lever", [inside.tolist()]])
        page.click("#stage", position={"x": x, "y": y})
        page.wait_for_timeout(100)
        assert page.text_content("#release").startswith("Following lever")
        assert page.eval_on_selector("#whose", "box => box.selectedOptions[0].text") == "lever"
        place = "([name, points]) => watchsim.seen(name, points)[0]"
        there = np.array(page.evaluate(place, ["lever", [inside.tolist()]]))
        page.evaluate("watchsim.seek(watchsim.window[0] + 0.3)")
        assert np.allclose(page.evaluate(place, ["lever", [inside.tolist()]]), there, atol=1e-6)


def silent(page: Any) -> bool:
    """Nothing said but what a graphics card without a screen says of itself when somebody takes a picture."""
    return all("GL Driver Message" in line for line in page.said)


def test_solids_from_above_lie_on_the_flat_picture_in_its_colours(run: Trajectory, written: Path) -> None:
    with opened(written) as page:
        enlarged(page)
        page.evaluate("watchsim.mark(false, false)")
        shots = []
        for canvas in ("stage", "solid"):
            text = page.evaluate("name => { watchsim.seek(1.815); return document.getElementById(name).toDataURL(); }", canvas)
            shots.append(iio.imread(io.BytesIO(base64.b64decode(text.split(",", 1)[1]))))
            page.evaluate("watchsim.space(0, 0)")
        flat, solid = shots[0], shots[1][::2, ::2]
        assert flat.shape[:2] == solid.shape[:2]
        for finish in (BRASS, STEEL, RUBY):
            inside = minimum_filter(filled(flat, finish.fill), size=5)  # without the edges that only the flat picture draws
            same = filled(solid, finish.fill)[inside]
            assert inside.sum() > 100 and same.mean() > 0.85, (finish, same.mean())  # roller and spring cover the fork
        assert silent(page) and set(page.asked) == {written.absolute().as_uri()}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_frame_in_space_has_the_colours_of_the_palette(run: Trajectory, written: Path, scheme: str) -> None:
    """Seen from above, at pixels chosen by geometry alone: in one part, 3 pixels from its edges, and in or near no other."""
    random, t = np.random.default_rng(1), float(run.t[-1]) - 0.21
    found = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    shapes = []
    for part in drawn_parts(run.scene, 0.03):
        rings = [(Polygon(polyline(loop, 2e-7)).buffer(0.0), loop.hole) for loop in part.outlines]
        bare = unary_union([ring for ring, hole in rings if not hole]).difference(
            unary_union([ring for ring, hole in rings if hole])
        )
        x, y, angle = found[part.body].tolist()
        c, s = np.cos(angle), np.sin(angle)
        shapes.append((part, affine_transform(bare, [c, -s, s, c, x, y]), (x, y, c, s)))
    coils = [LineString(spring.line(found, 2000)).buffer(1e-4) for spring in hairsprings(run.scene)]
    off: dict[str, list[float]] = {}
    with opened(written, scheme=scheme) as page:
        page.evaluate("watchsim.mark(false, false)")
        page.evaluate("t => { watchsim.seek(t); watchsim.space(0, 0); }", t)
        page.wait_for_timeout(600)
        text = page.evaluate("t => { watchsim.seek(t); return document.getElementById('solid').toDataURL(); }", t)
        shown = iio.imread(io.BytesIO(base64.b64decode(text.split(",", 1)[1])))
        ratio = page.evaluate("document.getElementById('solid').width / document.getElementById('solid').clientWidth")
        ends = np.array(page.evaluate("watchsim.seen('wheel', [[0, 0], [1e-3, 0]])"))
        edge = 3.0 * 1e-3 / float(np.hypot(*(ends[1] - ends[0])))
        for part, shape, (x, y, c, s) in shapes:
            others = unary_union([other for one, other, _ in shapes if one is not part] + coils)
            free = shape.buffer(-edge).difference(others.buffer(edge))
            if free.is_empty:
                continue
            low, high = np.array(free.bounds[:2]), np.array(free.bounds[2:])
            inside = [point for point in random.uniform(low, high, (3000, 2)).tolist() if free.contains(Point(point))][:60]
            local = [[c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)] for px, py in inside]
            pixels = ratio * np.array(page.evaluate("([n, p]) => watchsim.seen(n, p)", [part.body, local])).reshape(-1, 2)
            for column, row in pixels.astype(int).tolist():
                if 0 <= row < shown.shape[0] and 0 <= column < shown.shape[1]:
                    seen = f"#{bytes(shown[row, column, :3].tolist()).hex()}"
                    off.setdefault(part.layer, []).append(
                        float(np.linalg.norm(lab(linear(seen)) - lab(linear(part.finish.fill))))
                    )
    assert {"TEETH", "STONES", "ARMS", "RIM"} <= set(off) and sum(map(len, off.values())) > 150
    assert max(max(values) for values in off.values()) < 3.0, {layer: max(values) for layer, values in off.items()}


def shot_of(page: Any, text: str) -> Any:
    """A picture (rows, columns, RGB) of the data address that a script returns."""
    return iio.imread(io.BytesIO(base64.b64decode(page.evaluate(text).split(",", 1)[1])))[..., :3].astype(int)


SOLID = "(() => { watchsim.seek(watchsim.window[0]); return document.getElementById('solid').toDataURL(); })()"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_changes_how_bright_a_tilted_face_is_and_not_its_hue(written: Path, scheme: str) -> None:
    """Where a face is evenly lit, its colour is that of the palette at the brightness that is seen: of metal up to the
    opening tilt nearly everywhere, of stones, which mirror light of any colour besides, less closely."""
    off: dict[str, list[Any]] = {}
    with opened(written, scheme=scheme) as page:
        page.focus("#stage")
        data = json.loads(page.text_content("#data"))
        worn = [(one["body"], one["fill"]) for one in data["solids"]["pieces"]]
        worn += [(one["body"], one["colours"][0]) for one in data["coils"]]
        for tilt, yaw in itertools.product((0.3, 0.6, 0.85), (0.0, 1.6, 3.1, 4.7)):
            page.evaluate("([tilt, yaw]) => watchsim.space(tilt, yaw)", [tilt, yaw])
            page.wait_for_timeout(100)
            seen, number = shot_of(page, SOLID), shot_of(page, "watchsim.numbered()")
            body = number[..., 0] + 256 * number[..., 1] - 1
            even = (minimum_filter(body, 7) == maximum_filter(body, 7)) & (body >= 0)
            even &= (
                np.ptp(np.stack([maximum_filter(seen, (5, 5, 1)), minimum_filter(seen, (5, 5, 1))]), axis=0).max(axis=2) <= 12
            )
            for own in np.unique(body[even]).tolist():
                chosen = np.unique(seen[even & (body == own)], axis=0, return_counts=True)
                for colour, count in zip(*chosen, strict=True):
                    light = linear(f"#{bytes(colour.tolist()).hex()}")
                    same = {
                        fill: linear(fill) * (TO_XYZ[1] @ light) / (TO_XYZ[1] @ linear(fill)) for b, fill in worn if b == own
                    }
                    apart = {fill: float(np.linalg.norm(lab(light) - lab(one))) for fill, one in same.items()}
                    nearest = min(apart, key=apart.__getitem__)
                    off.setdefault(nearest, []).append((apart[nearest], int(count)))
    assert {BRASS.fill, STEEL.fill, RUBY.fill, FIXED.fill} <= set(off)
    for fill, found in off.items():
        apart, counts = (np.array(column) for column in zip(*sorted(found), strict=True))
        share = np.cumsum(counts) / counts.sum()
        assert apart[np.searchsorted(share, 0.5)] < (6.0 if fill == RUBY.fill else 1.0), fill
        assert apart[np.searchsorted(share, 0.95)] < (12.0 if fill == RUBY.fill else 3.0), fill


WRITTEN = """(() => {
  const said = [], write = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) { said.push(text); write.call(this, text, ...at); };
  watchsim.seek(watchsim.window[0]);
  CanvasRenderingContext2D.prototype.fillText = write;
  return said;
})()"""  # the texts that the player writes for an instant


@pytest.mark.parametrize("profile", ["swiss_lever", "graham"])
def test_names_in_space_stand_apart_and_on_their_parts(profile: str, tmp_path: Path) -> None:
    """A name points at its body, drawn alone; from above it points where it does in the flat picture."""
    run = simulate(load(Path(str(profiles_dir())) / profile / "scene.toml"), duration=1.2, record="all")
    with opened(report(run, tmp_path / "page.html")) as page:
        page.focus("#stage")
        page.keyboard.press("l")
        flat = {one["text"]: one["at"] for one in page.evaluate("watchsim.names()")}
        page.evaluate("watchsim.space(0, 0)")
        above = {one["text"]: one["at"] for one in page.evaluate("watchsim.names()")}
        assert all(above[text] == pytest.approx(at, abs=0.01) for text, at in flat.items())
        for tilt, yaw in ((0.85, 0.35), (0.6, -0.8), (1.1, 0.2)):
            page.evaluate("([tilt, yaw]) => watchsim.space(tilt, yaw)", [tilt, yaw])
            page.wait_for_timeout(100)
            names = page.evaluate("watchsim.names()")
            assert len(names) >= 3
            check_apart(names)
            for one in names:
                if one["body"] >= 0:
                    alone = shot_of(page, f"watchsim.numbered({one['body']})")
                    x, y = np.array(one["at"]) * alone.shape[1] / page.evaluate("document.getElementById('stage').clientWidth")
                    near = alone[max(int(y) - 3, 0) : int(y) + 4, max(int(x) - 3, 0) : int(x) + 4, 0]
                    hollow = np.allclose(next(each.point for each in part_names(run.scene) if each.text == one["text"]), 0.0)
                    assert hollow or (near == one["body"] + 1).any(), one["text"]
        assert set(page.evaluate(WRITTEN)) >= {one["text"] for one in names}
        assert "above" in page.get_attribute("#stage", "class") and silent(page)


def test_solids_are_turned_chosen_and_put_away(run: Trajectory, written: Path) -> None:
    with opened(written) as page:
        page.focus("#stage")
        page.keyboard.press("3")
        page.wait_for_selector('#space[aria-pressed="true"]')
        assert page.is_visible("#solid")
        page.evaluate("watchsim.space(0, 0)")
        stone = next(loop for loop in run.scene.body("lever").loops if loop.layer == "STONES")
        inside = polyline(stone, 1e-5)[:-1].mean(axis=0)
        ((x, y),) = page.evaluate("([name, points]) => watchsim.seen(name, points)", ["lever", [inside.tolist()]])
        page.click("#stage", position={"x": x, "y": y})
        page.wait_for_selector("#release:not([hidden])")
        assert page.text_content("#release").startswith("Following lever")
        page.keyboard.press("Alt+ArrowDown")
        page.keyboard.press("3")
        page.wait_for_selector('#space[aria-pressed="false"]')
        assert not page.is_visible("#solid") and silent(page)


def test_moving_solids_are_coarser_where_frames_are_slow_and_fine_at_rest(written: Path) -> None:
    """Frames of 40 ms lead down rung by rung, frames in time up again, later each time; scripts alone change nothing."""
    frames = """([gap, own, count]) => {
      for (let i = 0; i < count; i++) watchsim.fineness().frame(gap, own);
      return watchsim.fineness().ratio;
    }"""
    with opened(written) as page:
        page.focus("#stage")
        page.keyboard.press("3")
        page.wait_for_selector('#space[aria-pressed="true"]')
        width = lambda: page.evaluate("document.getElementById('solid').width")  # noqa: E731
        page.wait_for_function("document.getElementById('solid').width > 300")
        still = width()
        assert page.evaluate(frames, [40.0, 30.0, 504]) == 2.0
        # A screen of 60 Hz shows 50 frames/s as four of one period and one of two.
        assert page.evaluate("[...Array(12)].forEach((_, k) => watchsim.fineness().frame(k % 5 ? 16.7 : 33.3, 3))") is None
        assert [page.evaluate(frames, [40.0, 3.0, 12]) for _ in range(4)] == [1.0, 0.75, 0.5, 0.5]
        assert page.evaluate(frames, [20.0, 3.0, 504]) == 0.5
        page.keyboard.press("Space")
        page.wait_for_function("wide => document.getElementById('solid').width < wide / 2", arg=still)
        page.keyboard.press("Space")
        page.wait_for_function("wide => document.getElementById('solid').width === wide", arg=still)
        first, second, third = page.evaluate("""() => {
          const pace = watchsim.fineness();
          const wait = () => { let n = 0; for (; pace.rung === 4; n++) pace.frame(16, 3); return n; };
          return [1, 2, 3].map(() => { while (pace.rung < 4) pace.frame(40, 3); return wait(); });
        }""")
        assert first < second < third
        assert silent(page)


def crossing(one: Any, other: Any) -> bool:
    (a, b), (c, d) = (np.array(line) for line in (one, other))
    side = lambda p, q, r: np.sign((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))  # noqa: E731
    return bool(side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0)


def check_apart(names: list[dict[str, Any]]) -> None:
    """Neither do names lie on each other, nor do their lines cross."""
    for one, other in itertools.combinations(names, 2):
        (a, b, c, d), (e, f, g, h) = one["box"], other["box"]
        assert c < e or g < a or d < f or h < b, (one["text"], other["text"])
        assert not crossing((one["from"], one["at"]), (other["from"], other["at"])), (one["text"], other["text"])


def test_the_page_of_a_clock_opens_with_its_escapement_and_the_whole_beside_it(tmp_path: Path) -> None:
    run = simulate(load(Path(str(profiles_dir())) / "graham" / "scene.toml"), duration=1.2, record="all")
    with opened(report(run, tmp_path / "page.html")) as page:

        def wide() -> float:
            page.wait_for_timeout(100)
            page.evaluate("watchsim.seek(watchsim.window[0])")
            teeth = [polyline(loop, 1e-5) for loop in run.scene.body("wheel").loops if not loop.hole]
            return float(np.ptp(page.evaluate("p => watchsim.seen('wheel', p)", np.concatenate(teeth).tolist()), axis=0)[0])

        assert wide() > 250.0
        left, top, width, height = page.evaluate("watchsim.corner()")
        page.keyboard.press("0")
        assert wide() < 100.0 and page.evaluate("watchsim.corner()") is None
        page.keyboard.press("0")
        assert wide() > 250.0 and page.evaluate("watchsim.corner()") == [left, top, width, height]
        box = page.evaluate("document.getElementById('stage').getBoundingClientRect().toJSON()")
        assert left > 0.0 and top > 0.0 and left + width < 0.3 * box["width"] and top + height < box["height"]
        assert page.said == []


@pytest.mark.parametrize("profile", ["coaxial", "graham"])
def test_on_a_phone_held_sideways_picture_and_controls_are_seen_at_once(profile: str, tmp_path: Path) -> None:
    run = simulate(load(Path(str(profiles_dir())) / profile / "scene.toml"), duration=1.2, record="all")
    with opened(report(run, tmp_path / "page.html"), 740, 360) as page:
        bar, picture = (page.locator(which).bounding_box() for which in (".bar", "#picture"))
        assert bar["y"] + bar["height"] <= 360.0 and bar["height"] < 60.0
        assert picture["height"] > 200.0 and picture["y"] + picture["height"] <= bar["y"] + 25.0
        assert all(one.bounding_box()["x"] + one.bounding_box()["width"] <= 740.0 for one in page.locator(".bar button").all())


def test_a_long_verdict_is_cut_on_a_phone_held_sideways_until_it_is_touched(written: Path) -> None:
    with opened(written, 740, 360) as page:
        verdict = page.locator(".verdict")
        told, line = verdict.inner_text(), verdict.bounding_box()
        assert len(told) > 110 and told.startswith("Not settled yet")
        assert line["height"] < 30.0 and line["x"] + line["width"] <= 740.0
        assert verdict.evaluate("one => one.scrollWidth > one.clientWidth && getComputedStyle(one).textOverflow === 'ellipsis'")
        verdict.hover()
        assert verdict.evaluate("one => one.scrollWidth <= one.clientWidth") and verdict.bounding_box()["height"] > 30.0


CLASHES = """() => [...document.querySelectorAll('.phases tr')].flatMap((row) => {
  const words = (cell) => {
    const range = document.createRange();
    range.selectNodeContents(cell);
    return range.getBoundingClientRect();
  };
  const spans = [...row.cells].map(words);
  return spans.slice(1).map((span, k) => span.left - spans[k].right).filter((gap) => gap < 4);
})"""  # between the words of neighbouring cells, CSS pixels


@pytest.mark.parametrize("profile", ["coaxial", "detent"])
def test_words_of_neighbouring_columns_stay_apart_at_any_width(profile: str, tmp_path: Path) -> None:
    run = simulate(load(Path(str(profiles_dir())) / profile / "scene.toml"), duration=2.5, record="all")
    target = report(run, tmp_path / "page.html")
    for width in (360, 768, 1280):
        with opened(target, width, 800) as page:
            assert page.locator(".phases tr").count() > 4 and page.evaluate(CLASHES) == []
            assert page.evaluate("document.documentElement.scrollWidth") == width
            ends = "[...document.querySelectorAll('.energy text')].map((one) => one.getBBox().x + one.getBBox().width)"
            assert max(page.evaluate(ends)) <= WIDTH


def test_rounding_of_a_torque_does_not_fill_its_panel(run: Trajectory, written: Path) -> None:
    """A lever on its banking has no torque but that of rounding, a million times and more below that of its jumps."""
    largest = float(np.abs(run.a[:, run.slices["lever"]]).max()) * run.scene.body("lever").inertia
    still = np.abs(run.u[:, run.slices["lever"].start]) < 1e-9
    ends = np.flatnonzero(np.diff(still.astype(int)))
    start, end = max(zip(run.t[ends[:-1]], run.t[ends[1:]], strict=True), key=lambda span: span[1] - span[0])
    with opened(written) as page:
        page.select_option("#whose", label="lever")
        plot = (
            page.locator("#plots .plot b")
            .all_inner_texts()
            .index(next(text for text in page.locator("#plots .plot b").all_inner_texts() if text.startswith("Net torque")))
        )
        page.evaluate("t => watchsim.seek(t)", 0.5 * (start + end))
        whole = page.evaluate("plot => watchsim.limits(plot)", plot)
        for _ in range(6):
            page.click("#narrow")
        page.wait_for_timeout(200)
        low, high = page.evaluate("plot => watchsim.limits(plot)", plot)
        assert low < 0.0 < high and high - low < 0.1 * (whole[1] - whole[0])  # nothing of a jump is shown
        assert high - low > 0.9e-3 * largest
        assert page.said == []


def test_names_with_underscores_are_read_as_words_and_wear_takes_the_colours_of_the_page(tmp_path: Path) -> None:
    text = (Path(str(profiles_dir())) / "incline" / "scene.toml").read_text().split("[expect]")[0]
    (tmp_path / "scene.toml").write_text(text.replace("disc", "small_disc").replace("friction    = 0.3", "friction = 0.02"))
    run = simulate(load(tmp_path / "scene.toml"), duration=1.0, record="all")
    with opened(report(run, tmp_path / "page.html"), scheme="dark") as page:
        buttons = page.locator("#parts button").all_text_contents()
        assert any(one.startswith("small disc") for one in buttons) and not any("_" in one for one in buttons)
        pictures = [page.locator(f".wear .{which} img") for which in ("light", "night")]
        assert [one.is_visible() for one in pictures] == [False, True]
        assert iio.imread(pictures[1].screenshot())[5, 5, :3].max() < 60
        page.click("#theme")
        assert [one.is_visible() for one in pictures] == [True, False]


@pytest.mark.parametrize("profile", ["swiss_lever", "coaxial", "graham", "pin_pallet", "cylinder"])
def test_names_stand_apart_and_on_their_parts(profile: str, tmp_path: Path) -> None:
    scene = load(Path(str(profiles_dir())) / profile / "scene.toml")
    run = simulate(scene, duration=1.2, record="all")
    with opened(report(run, tmp_path / "page.html")) as page:
        page.focus("#stage")
        page.keyboard.press("l")
        page.wait_for_selector('#label[aria-pressed="true"]')
        for t in np.linspace(*page.evaluate("watchsim.window"), 10).tolist():
            page.evaluate("t => watchsim.seek(t)", t)
            names = page.evaluate("watchsim.names()")
            assert len(names) >= 3
            check_apart(names)
            for one in names:
                if one["body"] < 0:
                    continue
                body = run.scene.bodies[one["body"]]
                seen = lambda points: page.evaluate("([n, p]) => watchsim.seen(n, p)", [body.name, points])  # noqa: B023, E731
                shapes = [ClosedPath(seen(polyline(loop, 1e-5).tolist())) for loop in loops_of(body) if loop.closed]
                pivot = np.hypot(*(np.array(seen([[0.0, 0.0]])[0]) - one["at"])) < 0.1
                assert (
                    pivot
                    or any(shape.contains_point(one["at"], radius=1.0) for shape in shapes)
                    or any(shape.contains_point(one["at"], radius=-1.0) for shape in shapes)
                ), one["text"]
        assert page.said == []


def test_a_printed_clock_has_the_whole_in_an_inset_with_its_bob_where_the_run_has_it(tmp_path: Path) -> None:
    run = simulate(load(Path(str(profiles_dir())) / "graham" / "scene.toml"), duration=1.2, record="all")
    bob, radius = np.array((0.0, -248.5)), 30.0  # mm, in the pendulum's drawing
    whole = """(() => { const small = document.querySelector('#poster use').getScreenCTM();
      const m = small.multiply(document.getElementById('drawn').transform.baseVal[0].matrix);
      return [[m.a, m.c, m.e], [m.b, m.d, m.f]]; })()"""
    with opened(report(run, tmp_path / "page.html"), scheme="dark", ratio=3.0) as page:
        page.emulate_media(media="print", color_scheme="dark")
        shots = []
        for t in (0.6, 1.1):
            page.evaluate("t => { watchsim.seek(t); window.dispatchEvent(new Event('beforeprint')); }", t)
            page.wait_for_timeout(100)
            shots.append(iio.imread(page.screenshot())[..., :3].astype(int))
            x, y, angle = poses(run, np.array([t]))["pendulum"][0]
            c, s = np.cos(angle), np.sin(angle)

            def pixel(right: float, up: float) -> Any:
                home = bob + np.array((right, up))
                there = 1e3 * np.array((x, y)) + np.array([[c, -s], [s, c]]) @ home  # noqa: B023
                column, row = np.round(3.0 * np.array(page.evaluate(whole)) @ (*there, 1.0)).astype(int)
                return shots[-1][row, column]

            inside = [pixel(0.8 * radius * i, 0.8 * radius * j) for i, j in ((1, 0), (-1, 0), (0, -1))]
            assert np.ptp(inside, axis=0).max() < 10 and inside[0].min() < 225, "one colour, and no paper"
            for right, up in ((1.2, 0.0), (-1.2, 0.0), (0.0, -1.1)):
                assert pixel(right * radius, up * radius).min() > 245, "paper all round"
        assert (shots[0] != shots[1]).any()
        assert page.said == []


DRAWN = """places => new Promise((done) => requestAnimationFrame(() => {
  const said = [], write = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) { said.push(text); write.call(this, text, ...at); };
  requestAnimationFrame(() => {
    CanvasRenderingContext2D.prototype.fillText = write;
    done({ said, at: places.map(([body, point]) => watchsim.seen(body, [point])[0]) });
  });
}))"""  # the texts of one frame of the player, and where places of bodies are seen in it


def test_while_it_plays_a_name_is_hidden_for_as_long_as_its_part_is_out_of_sight(tmp_path: Path) -> None:
    run = simulate(load(Path(str(profiles_dir())) / "coaxial" / "scene.toml"), duration=1.2, record="all")
    names = [one for one in part_names(run.scene) if one.body is not None]
    with opened(report(run, tmp_path / "page.html")) as page:
        page.focus("#stage")
        page.keyboard.press("l")
        page.keyboard.press("a")
        for key in "++++++++++>>>>>>>>":
            page.keyboard.press(key)
        page.keyboard.press("Space")
        box = page.locator("#stage").bounding_box()
        shown, hidden, changes = set(), set(), set()
        for _ in range(60):
            page.wait_for_timeout(40)
            found = page.evaluate(DRAWN, [[one.body, list(one.point)] for one in names])
            within = [0 < x < box["width"] and 0 < y < box["height"] for x, y in found["at"]]
            inside = {one.text for one, there in zip(names, within, strict=True) if there}
            texts = {one.text for one in names} & set(found["said"])
            assert texts <= inside, texts - inside
            shown, hidden, changes = shown | texts, hidden | {one.text for one in names} - inside, changes | {frozenset(texts)}
        assert shown & hidden and len(changes) > 1, "a name comes and goes"
        assert page.said == []


def test_an_audit_of_accessibility_passes(written: Path) -> None:
    audit = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="axe is not installed: pip install 'watchsim[browser]'"
    )
    for width, scheme in ((1280, "light"), (1280, "dark"), (360, "light")):
        with opened(written, width, 800, scheme) as page:
            found = audit.Axe().run(page).response["violations"]
            assert not found, json.dumps(
                [(one["id"], [node["html"][:120] for node in one["nodes"]]) for one in found], indent=1
            )


def test_focus_goes_through_the_page_in_its_order(written: Path) -> None:
    with opened(written) as page:
        seen = []
        for _ in range(60):
            page.keyboard.press("Tab")
            seen.append(page.evaluate("document.activeElement.id || document.activeElement.textContent"))
        wanted = ("theme", "print", "stage", "back", "play", "next", "speed", "adapt", "scrub", "whose")
        places = [seen.index(name) for name in wanted]
        assert places == sorted(places)


def test_saved_files_are_those_of_the_run(run: Trajectory, written: Path) -> None:
    with opened(written) as page:
        with page.expect_download() as waiting:
            page.click("text=Everything")
        with zipfile.ZipFile(waiting.value.path()) as archive:
            names = archive.namelist()
            assert archive.testzip() is None
            assert {"scene.lock.toml", "summary.json", "beats.csv", "phases.csv"} <= set(names)
            drawing = next(name for name in names if name.endswith(".dxf"))
            content = archive.read(drawing)
            assert content in run.scene.drawings.values()
        with page.expect_download() as waiting:
            page.click(f"text={drawing}")
        assert Path(waiting.value.path()).read_bytes() == content


def test_it_keeps_up_with_the_screen(written: Path) -> None:
    """Drawing a frame at 1280 × 720 takes a fraction of the 16.7 ms that a screen leaves."""
    with opened(written) as page:
        enlarged(page)
        page.evaluate("document.getElementById('push').click()")
        page.evaluate("document.getElementById('play').click()")
        took = []
        for _ in range(20):
            page.wait_for_timeout(50)
            took.append(page.evaluate("watchsim.pace().drawn"))
        assert np.percentile(took, 25) < 8.0


def test_a_processor_has_time_for_sixty_frames_a_second(written: Path) -> None:
    with opened(written, *SIZE) as page:
        found = played(page, 4.0)
        assert page.said == []
    assert found.frames > 10
    assert found.busy / found.frames < 1.0 / 60.0


def test_a_comparison_shows_the_old_outlines_as_ghosts_and_g_hides_them(tmp_path: Path) -> None:
    graham = load(profiles_dir() / "graham")
    sides = [side_of(simulate(graham.set("design.lock", lock), 4.0)) for lock in ("0.4°", "0.6°")]
    with opened(comparison_page(compare(*sides), tmp_path / "both.html")) as page:
        shown = [page.evaluate("window.watchsim.ghost()")]
        for _ in range(2):
            page.keyboard.press("g")
            shown.append(page.evaluate("window.watchsim.ghost()"))
        assert shown[0] > 0 and shown == [shown[0], 0, shown[0]]
        assert page.said == [] and len(page.asked) == 1
        assert "lock" in page.locator("section.changed th").all_inner_texts()  # in words, not as the key "design.lock"
        ghosts = page.evaluate("JSON.parse(document.getElementById('data').textContent).ghost.parts")
    # The pallets are locked elsewhere; wheel, rod and bob are the same, and no ghost lies on their lines.
    assert {part["layer"] for part in ghosts} == {"PALLETS"}


def test_what_a_phone_cuts_of_a_study_is_scrolled_and_shaded(tmp_path: Path) -> None:
    guide = Path(__file__).parents[2] / "docs" / "guide" / "tolerances" / "swiss_lever.toml"
    target = tolerance_page(tolerance(guide, 16), tmp_path / "study.html")
    with opened(target, 360, 740, script=False) as page:
        assert page.evaluate("document.documentElement.scrollWidth") == 360
        cut = page.locator(".scroll").filter(has=page.locator("table, img"))
        wide = [one for one in cut.all() if one.evaluate("box => box.scrollWidth > box.clientWidth")]
        assert len(wide) >= 3 and all(one.get_attribute("tabindex") == "0" for one in wide)

        def shades(one: Any) -> list[bool]:
            """Is there a shade at the left and right edge, halfway down?"""
            one.scroll_into_view_if_needed()
            shot = iio.imread(one.screenshot())[..., :3].astype(int).sum(axis=2)
            return [bool(np.median(shot[:, side]) < np.median(shot[:, inward]) - 30) for side, inward in ((0, 20), (-1, -20))]

        for one in (wide[0], page.locator(".scroll:has(img)")):
            assert shades(one) == [False, True]
            one.evaluate("box => { box.scrollLeft = box.scrollWidth; }")
            assert not shades(one)[1]
