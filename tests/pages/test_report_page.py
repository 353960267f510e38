"""Is a page whole, closed to the network and to what titles might smuggle in, and does it hold the motion?"""

import base64
import dataclasses
import hashlib
import html
import json
import math
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from render.fake_runs import disc_run, watch_run
from scipy.interpolate import BPoly

from watchsim.analysis.headlines import headlines
from watchsim.analysis.phases import Phase
from watchsim.analysis.summary import summary
from watchsim.analysis.timeline import shown_beats, timeline_text
from watchsim.cli import main
from watchsim.drawing.read import read
from watchsim.escapement.function_report import statics, text
from watchsim.escapement.measure import measure
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Arc, Line
from watchsim.pages import charts
from watchsim.pages.charts import bars
from watchsim.pages.html import SCRIPTS, element, embedded, joined
from watchsim.pages.player import TooMuch, channels, path_data, shown
from watchsim.pages.report_page import page_parts, page_text, report
from watchsim.pages.solids import packed_solids
from watchsim.pages.timing_sheet import phase_tables, sheet, verdict
from watchsim.paths import profiles_dir
from watchsim.render.palette import ENERGIES
from watchsim.render.part_names import part_names
from watchsim.render.rows import kept_rows
from watchsim.render.wear_plot import plot_wear
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

NASTY = "</script><img src=x onerror=alert(1)>\"'<!-- & <svg onload=alert(2)>"


@pytest.fixture(scope="module")
def lever() -> Trajectory:
    return simulate(load(Path(str(profiles_dir())) / "bench_lever" / "scene.toml"), duration=0.6)


@pytest.fixture(scope="module")
def lever_page(lever: Trajectory) -> str:
    return page_text(lever)


class Tags(HTMLParser):
    """Every element with its attributes, and the text of scripts."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self._inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append("")
        self._inside = tag == "script"

    def handle_endtag(self, tag: str) -> None:
        self._inside = False

    def handle_data(self, data: str) -> None:
        if self._inside:
            self.scripts[-1] += data


def data_of(text: str) -> dict:
    return json.loads(Tags(text).scripts[0])


def test_a_page_asks_nothing_of_the_network(lever_page: str) -> None:
    for tag, attributes in Tags(lever_page).found:
        assert tag not in ("iframe", "object", "embed", "base", "form")
        for name in ("src", "href", "action", "srcset", "xlink:href"):
            value = attributes.get(name)
            assert value is None or value.startswith(("#", "data:,", "data:image/png;base64,")), (tag, value)
    credit = "/*! https://github.com/leeoniya/uPlot (v1.6.32) */"  # a comment, as its licence asks
    assert lever_page.count(credit) == 1 and "Permission is hereby granted" in lever_page
    rest = re.sub(r'"data":"[^"]*"', "", lever_page.replace(credit, ""))
    assert not re.search(r"(https?:)?//[a-z0-9.-]+\.[a-z]{2,}", rest)
    assert "@import" not in lever_page and "url(" not in lever_page


def test_only_its_own_script_may_run(lever_page: str) -> None:
    policy = next(a["content"] for tag, a in Tags(lever_page).found if a.get("http-equiv") == "Content-Security-Policy")
    script = Tags(lever_page).scripts[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert policy is not None and "default-src 'none'" in policy and f"script-src 'sha256-{digest}'" in policy


def test_names_stay_text() -> None:
    run = watch_run(title=NASTY)
    bodies = tuple(dataclasses.replace(body, name=f"{body.name}{NASTY}") for body in run.scene.bodies)
    bodies = tuple(
        dataclasses.replace(b, loops=tuple(dataclasses.replace(x, layer=f"{x.layer}{NASTY}") for x in b.loops)) for b in bodies
    )
    slices = {f"{name}{NASTY}": part for name, part in run.slices.items()}
    scene = dataclasses.replace(run.scene, bodies=bodies, source={NASTY: {"key": NASTY}})
    run = dataclasses.replace(run, scene=dataclasses.replace(scene, source={}), slices=slices, pairs=())
    run = dataclasses.replace(run, events=run.events[:1])
    numbers = {**summary(run), "warnings": [NASTY], "verdict": "knocks", "verdict_message": NASTY}
    text = page_text(run, numbers=numbers)
    plain = page_text(watch_run())
    kinds = lambda page: {(tag, name) for tag, attributes in Tags(page).found for name in attributes}  # noqa: E731
    assert kinds(text) - kinds(plain) <= {
        ("li", "class"),
        ("p", "class"),
        ("section", "class"),
        ("section", "aria-labelledby"),
        ("h2", "id"),
    }
    assert not any(name.startswith("on") for _, attributes in Tags(text).found for name in attributes)
    assert text.count("<script") == text.count("</script>") == 2
    assert data_of(text)["title"] == NASTY


@given(st.text())
def test_any_text_is_only_text(text: str) -> None:
    told = element("p", text, title=text)
    parsed = Tags(told)
    assert [tag for tag, _ in parsed.found] == ["p"]
    assert "<" not in embedded({"key": text}) and json.loads(embedded(text)) == text
    assert "<" not in joined(text)


def test_the_size_is_bounded(lever_page: str) -> None:
    assert len(lever_page.encode()) < 400_000


def test_the_sheet_holds_the_headline_numbers(lever: Trajectory, lever_page: str) -> None:
    numbers = summary(lever)
    assert f"{numbers['vph']:.2f} vph" in lever_page
    assert f"{numbers['amplitude_deg']:.1f}"[:4] in lever_page
    for heading in ("Timing", "Phases of a beat", "Energy", "Parameters", "Files", "Keys"):
        assert f">{heading}</h2>" in lever_page


def test_the_sheet_holds_the_geometry_of_function_as_check_has_it(lever: Trajectory, lever_page: str) -> None:
    found = statics(measure(lever.scene))
    page = html.unescape(lever_page)
    for name, words in (("total_lock", "total lock"), ("drop", "drop of the wheel"), ("lift", "lift")):
        values = "".join(f"<td>{found[stone][f'{name}_deg']:.3f}°</td>" for stone in ("entry", "exit"))
        assert f'<th scope="row">{words}</th>{values}' in page
    assert 'id="h-function"' not in page_text(disc_run())


@pytest.mark.parametrize(
    ("numbers", "shown_text"),
    [
        ({"verdict": "ticks", "verdict_message": None}, '<p class="verdict good"><strong>The watch ticks</strong></p>'),
        (
            {"verdict": "knocks", "verdict_message": "at 3 s"},
            '<p class="verdict bad"><strong>The watch knocks</strong> at 3 s</p>',
        ),
        ({"verdict": "unsettled", "verdict_message": None}, '<p class="verdict open"><strong>Not settled yet</strong></p>'),
        ({"verdict": None}, None),
        ({"verdict": None, "stopped": True, "stopped_message": "it stands"}, "<strong>The watch stops</strong> it stands"),
    ],
)
def test_the_verdict_is_that_of_the_numbers(numbers: dict, shown_text: str | None) -> None:
    text = verdict(numbers) or ""
    assert shown_text in text if shown_text else not text


def test_the_verdict_is_shown_where_there_is_one(lever: Trajectory) -> None:
    text = page_text(lever, numbers={**summary(lever), "verdict": "knocks", "verdict_message": "at 3 s"})
    assert '<p class="verdict bad"><strong>The watch knocks</strong> at 3 s</p>' in text
    assert 'class="verdict' not in page_text(disc_run())


def test_rows_that_are_kept_tell_the_motion(lever: Trajectory) -> None:
    """By quintics of scipy through what is packed, in single precision."""
    window, size = (0.2, 0.6), 0.012
    found, off = channels(lever, window, size)
    times = np.random.default_rng(3).uniform(*window, 4000)
    q, _ = lever.sample(times)
    for channel in found:
        values = channel.values.astype(np.float32).astype(float)
        told, steps = np.empty(len(times)), np.searchsorted(channel.t, times, side="right") - 1
        for i in np.unique(steps):
            j = min(i + 1, len(channel.t) - 1)
            ends = [[channel.base[0] + values[k, 0], values[k, 1], values[k, 2]] for k in (i, j)]
            if channel.t[j] > channel.t[i]:
                told[steps == i] = BPoly.from_derivatives(channel.t[[i, j]], ends)(times[steps == i])
            else:
                told[steps == i] = ends[1][0]
        arm = max(0.25 * size, 0.002)
        assert np.abs(told - q[:, lever.slices[channel.body].start]).max() < 2.0 * off / arm + 1e-6
    assert len(found[0].t) < 0.8 * np.sum((lever.t >= window[0]) & (lever.t <= window[1]))


def test_too_much_motion_is_refused_or_cut(monkeypatch: pytest.MonkeyPatch, lever: Trajectory) -> None:
    monkeypatch.setattr("watchsim.pages.player.MOST_MOTION", 4_000)
    with pytest.raises(TooMuch, match="choose a shorter window"):
        page_text(lever, window=(0.0, 0.6))
    start, end = data_of(page_text(lever))["window"]
    assert end == pytest.approx(0.6) and 0.0 < end - start < 0.6


@given(st.lists(st.floats(-1.0, 1.0), min_size=0, max_size=60), st.sets(st.integers(0, 59)))
def test_thinning_keeps_ends_and_fits(values: list[float], forced: set[int]) -> None:
    y = np.cumsum(values)
    forced = {k for k in forced if k < len(y)}

    def fits(i: int, j: int) -> bool:
        line = np.interp(np.arange(i, j + 1), [i, j], [y[i], y[j]])
        return bool(np.all(np.abs(line - y[i : j + 1]) <= 0.3))

    kept = kept_rows(len(y), fits, forced)
    assert forced <= set(kept.tolist())
    if len(y):
        assert kept[0] == 0 and kept[-1] == len(y) - 1
        assert np.all(np.abs(np.interp(np.arange(len(y)), kept, y[kept]) - y) <= 0.3 + 1e-9)


def test_outlines_of_the_still_picture_are_the_drawings(tmp_path: Path) -> None:
    half = Arc(0.0, 0.0, 2e-3, 0.0, math.pi)
    shape = Loop((half, Line(-2e-3, 0.0, -1e-3, -3e-3), Line(-1e-3, -3e-3, 2e-3, 0.0)))
    disc = Loop((Arc(6e-3, 1e-3, 1.5e-3, 0.7, 2.0 * math.pi),))
    file = tmp_path / "still.svg"
    data = path_data([shape, disc])
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20"><path d="{data}"/></svg>'
    )
    back = read(file).profile.loops
    areas = sorted(abs(_area(polyline(loop, 1e-8))) for loop in back)
    assert areas == pytest.approx(sorted(abs(_area(polyline(loop, 1e-8))) for loop in (shape, disc)), rel=1e-5)


def _area(points: np.ndarray) -> float:
    x, y = points.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def test_ten_beats_are_shown_or_what_there_is(lever: Trajectory) -> None:
    assert shown(lever, None) == pytest.approx((0.0, 0.6))
    long = simulate(lever.scene, duration=1.6)
    assert shown(long, None) == pytest.approx((0.35, 1.6), abs=2e-3)
    assert shown(long, (0.1, 0.2)) == (0.1, 0.2)
    assert shown(disc_run(), None) == (0.0, 3.0)
    with pytest.raises(ValueError, match="was recorded"):
        shown(long, (1.5, 2.5))


def test_a_page_of_what_is_no_watch() -> None:
    text = page_text(disc_run())
    assert ">Timing</h2>" not in text and data_of(text)["view"]["follow"]["body"] == 0


def test_a_page_has_no_empty_timing_where_a_spring_only_presses() -> None:
    run = simulate(load(profiles_dir() / "jumper"), 0.02)
    assert ">Timing</h2>" not in page_text(run)


def test_a_page_needs_its_ending_and_is_written_whole(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"ends in \.html"):
        report(watch_run(), tmp_path / "watch.pdf")
    path = report(watch_run(), tmp_path / "watch.html")
    assert path.read_text(encoding="utf-8").endswith("</html>\n")
    assert [item.name for item in tmp_path.iterdir()] == ["watch.html"]


def test_the_same_run_makes_the_same_page() -> None:
    assert page_text(watch_run()) == page_text(watch_run())


def test_every_script_is_in_the_page() -> None:
    from importlib import resources

    names = {item.name for item in resources.files("watchsim.pages.assets").iterdir() if item.name.endswith(".js")}
    assert names == {f"{name}.js" for name in (*SCRIPTS, "live")}  # the last one follows a scene


def test_an_impulse_on_the_stone_and_one_on_the_tooth_are_told_apart_beat_by_beat() -> None:
    angles, turns = (0.0, 0.0, 0.0), (0.1, 0.2, 0.3)
    told = []
    for beat in (1, 3):
        t = float(beat)
        told += [
            Phase(beat, "unlock", t, t + 0.001, angles, angles),
            Phase(beat, "impulse", t + 0.001, t + 0.003, angles, turns, on="stone"),
            Phase(beat, "impulse", t + 0.003, t + 0.004, angles, turns, on="tooth"),
            Phase(beat, "impulse", t + 0.005, t + 0.007, angles, turns, on="stone"),  # it let go for a moment
        ]
    (section,) = phase_tables(told)
    cells = {}
    for row in re.findall(r"<tr><th scope=\"row\">.*?</tr>", str(section)):
        name, *values = (re.sub("<.*?>", "", cell) for cell in re.split("</t[hd]>", row)[:-1])
        cells[name] = values
    assert float(cells["impulse on stone"][0]) == pytest.approx(4.0) and float(cells["impulse on tooth"][0]) == pytest.approx(
        1.0
    )
    assert float(cells["impulse on stone"][-1]) == pytest.approx(math.degrees(0.2), abs=1e-3)
    assert "Odd beats: means of 2 beats" in str(section)


def test_a_rim_and_a_hairspring_are_in_data_and_still_picture(lever: Trajectory) -> None:
    scene = load(Path(str(profiles_dir())) / "swiss_lever")
    rim = dataclasses.replace(lever.scene.body("balance"), decoration=scene.body("balance").decoration)
    bodies = tuple(rim if body.name == "balance" else body for body in lever.scene.bodies)
    springs = tuple(dataclasses.replace(one, coil=scene.springs[0].coil) for one in lever.scene.springs)
    run = dataclasses.replace(lever, scene=dataclasses.replace(lever.scene, bodies=bodies, springs=springs))
    text = page_text(run)
    data = data_of(text)
    assert [part["layer"] for part in data["parts"] if part.get("pale")] == ["RIM"]
    (coil,) = data["coils"]
    assert data["bodies"][coil["body"]]["name"] == "balance" and coil["turns"] == 13
    assert 'data-coil="0"' in text and len(text) < 1e6
    assert data_of(page_text(lever))["coils"] == []


LAYERS = (NASTY, "quotes \" ' ` and \\ and {}${}%s", "tab\tand\nline \x7f \u2028 \u202e", "long " + 2_000 * "<b>&x;")


@pytest.mark.parametrize("layer", LAYERS, ids=["script", "quotes", "control", "10 kB"])
def test_layer_names_of_a_drawing_stay_text_in_page_and_glb(layer: str, tmp_path: Path) -> None:
    name = "".join(c if c.isalnum() else f"&#{ord(c)};" for c in layer)
    head = 'xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="-10 -10 20 20"'
    (tmp_path / "wheel.svg").write_text(f'<svg {head}><g id="{name}"><circle r="4"/></g></svg>', encoding="utf-8")
    (tmp_path / "scene.toml").write_text(
        f"""[scene]
title = {json.dumps(layer, ensure_ascii=False)}
schema = 1
[bodies.wheel]
drawing = "wheel.svg"
layers = [{json.dumps(layer, ensure_ascii=False)}]
inertia = "1 g·mm²"
[[springs]]
body = "wheel"
stiffness = "1 µN·m/rad"
rest = "90°"
[run]
duration = "0.1 s"
""".replace("\x7f", "\\u007f"),
        encoding="utf-8",
    )
    scene, run, out = (str(tmp_path / one) for one in ("scene.toml", "run", "out"))
    assert main(["run", scene, "-o", run, "--no-plots"]) == 0
    assert main(["report", run]) == 0
    text = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    assert not any(tag == "img" or any(key.startswith("on") for key in keys) for tag, keys in Tags(text).found)
    assert text.count("<script") == text.count("</script>") == 2
    assert data_of(text)["title"] == layer and [part["layer"] for part in data_of(text)["parts"]] == [layer]
    assert main(["export", run, "-o", out, "--format", "glb"]) == 0
    data = (tmp_path / "out" / "scene.glb").read_bytes()
    tree = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    assert [mesh["name"] for mesh in tree["meshes"]] == [f"wheel.{layer}"]


@pytest.mark.parametrize("profile", ["swiss_lever", "tourbillon", "verge", "graham"])
def test_triangles_of_solids_turn_as_their_normals_so_that_backs_need_no_drawing(profile: str) -> None:
    packed = packed_solids(load(profiles_dir() / profile), 0.02)
    assert packed
    for piece in packed["pieces"]:
        kinds = {"points": "<i2", "normals": "i1", "faces": "<u4" if piece["wide"] else "<u2"}
        points, normals, faces = (
            np.frombuffer(base64.b64decode(piece[key]), kind).reshape(-1, 3) for key, kind in kinds.items()
        )
        a, b, c = (points[faces[:, k]].astype(float) for k in range(3))
        facing = np.cross(b - a, c - a)
        along = np.sum(facing * normals[faces].astype(float).sum(axis=1), axis=1)
        assert np.all(along[np.linalg.norm(facing, axis=1) > 1e3] > 0.0)


@pytest.mark.parametrize(
    ("profile", "duration", "word", "others"),
    [
        ("graham", 4.0, "pallet", {"stone", "pin"}),
        ("pin_pallet", 1.5, "pin", {"stone"}),
        ("swiss_lever", 1.0, "stone", {"pallet"}),
    ],
)
def test_pallets_have_one_word_wherever_they_are_named(profile: str, duration: float, word: str, others: set[str]) -> None:
    """On the sheet, in noises and names, in the panels of wear, in beats and in phases."""
    run = simulate(load(profiles_dir() / profile), duration, record="all")
    names = {one.text for one in part_names(run.scene)}
    events = {event.split(": ")[0] for _, event in page_parts(run)[1]["events"]}
    panels = [axes.get_title() for axes in plot_wear(run).axes]
    said = [
        headlines(run, summary(run)),
        timeline_text(run, shown_beats(run)),
        *text(measure(run.scene)),
        *names,
        *events,
        *panels,
    ]
    said.append(re.sub("<[^>]*>", " ", str(sheet(run, summary(run))).split("h-parameters")[0]))
    words = set(re.findall(r"\b[a-z]+\b", " ".join(said).lower()))
    assert word in words and not words & (others | {f"{other}s" for other in others})
    assert {f"entry {word}", f"exit {word}"} <= names
    assert any(f"entry {word}" in panel for panel in panels) and any(f"entry {word}" in event for event in events)
    assert ("clock" if profile == "graham" else "watch") in (summary(run)["verdict_message"] or "clock watch")


def test_a_detent_has_one_stone_that_locks() -> None:
    run = simulate(load(profiles_dir() / "detent"), 2.5, record="all")
    names = [one.text for one in part_names(run.scene)]
    events = {event.split(": ")[0] for _, event in page_parts(run)[1]["events"]}
    assert names.count("locking stone") == names.count("passing spring") == 1
    assert {beat.pallet for beat in shown_beats(run)} == {"locking stone"}
    assert {"wheel / locking stone", "detent / banking"} <= events
    assert not any(word in " ".join((*names, *events)) for word in ("entry", "exit", "lever"))


# Do the charts of the page measure what they say?


@pytest.mark.parametrize("shares", [(0.75, 0.25), (0.5, -0.25), (-0.2, -0.8), (1.0,), (0.0, -0.5)])
def test_bars_run_from_one_line_in_proportion(shares: tuple[float, ...]) -> None:
    """To the right what is positive, to the left what is negative, all between the names and the words of the longest one."""
    text = str(bars([(f"n{k}", share, "") for k, share in enumerate(shares)], "shares", {}))
    drawn = [(float(x), float(width)) for x, width in re.findall(r'<rect[^>]* x="?([\d.-]+)"?[^>]* width="?([\d.]+)"?', text)]
    assert len(drawn) == len(shares)
    zeros = {round(x if share >= 0.0 else x + width, 1) for (x, width), share in zip(drawn, shares, strict=True)}
    assert max(zeros) - min(zeros) <= 0.8  # a share of nothing is a thin mark
    longest = max(map(abs, shares))
    unit = max(width for _, width in drawn) / longest
    for (x, width), share in zip(drawn, shares, strict=True):
        assert width == pytest.approx(max(unit * abs(share), 0.8), abs=0.02)
        assert x >= 204.9
    assert max(x + width for x, width in drawn) - min(x for x, _ in drawn) == pytest.approx(
        unit * (max(0.0, *shares, 0.0) - min(0.0, *shares, 0.0)), abs=0.9
    )


def test_energy_kinds_have_the_colours_of_the_plots() -> None:
    style = (Path(charts.__file__).parent / "assets" / "page.css").read_text(encoding="utf-8")
    light = re.search(r"--s0: .*", style)
    assert light is not None
    own = dict(re.findall(r"--(s\d): (#\w+);", light.group()))
    text = str(bars([(kind, 0.2, "") for kind in ENERGIES], "shares", ENERGIES))
    assert [own[number] for number in re.findall(r'class="(s\d)"', text)] == list(ENERGIES.values())
