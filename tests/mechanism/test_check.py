"""Does `watchsim check` echo what the scene amounts to, in the right words and numbers?"""

import itertools
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import shapely
from shapely.affinity import rotate, translate

import watchsim as ws
from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE
from watchsim.geometry.loops import polyline
from watchsim.mechanism.check import check_report, check_text, modelled_pairs, notes
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.contacts import PairCount
from watchsim.mechanism.words import force_lines, length, place, turned
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene

# Does the check echo what the scene amounts to, in the fixed names?

PAIRS = (PairCount(("wheel", "lever"), 120, 17, 3, 5, 2),)


def test_report(desk):
    report = check_report(load(desk.scene()), PAIRS)
    assert set(report) == {"bodies", "theory", "pairs", "statics", "tolerances", "findings"}
    assert report["bodies"]["lever"] == {
        "mass_kg": 0.0,
        "inertia_kg_m2": pytest.approx(3e-12),
        "position_m": [0.0, 0.009],
        "coordinates": 1,
        "centre_of_mass_m": [0.0, 0.0],
        "solids": [],
        "driven": False,
    }
    assert report["bodies"]["banking"]["coordinates"] == 0
    assert report["theory"] == {"frequency_hz": pytest.approx(4.0, rel=1e-15), "vph": pytest.approx(28800.0, rel=1e-15)}
    assert {name: report["pairs"][name] for name in ("declared", "reachable", "typical")} == {
        "declared": 120,
        "reachable": 17,
        "typical": 3,
    }
    for finding in report["findings"]:
        assert set(finding) == {"code", "severity", "layer", "x_mm", "y_mm", "message", "fix"}
    json.dumps(report)


def test_no_oscillator(desk):
    report = check_report(load(desk.scene('[bodies.a]\ninertia = "1 g·cm²"\n')), PAIRS)
    assert report["theory"] == {"frequency_hz": None, "vph": None}


def test_overlaps_are_findings(desk, good):
    report = check_report(load(desk.scene(good.replace('["0 mm", "9 mm"]', '["0 mm", "4 mm"]'))), PAIRS)
    found = [finding for finding in report["findings"] if finding["code"] == "overlap"]
    assert [finding["severity"] for finding in found] == ["error"]
    assert "wheel and lever overlap by" in found[0]["message"]


def test_gravity_on_a_body_without_mass_is_mentioned(desk, good):
    text = good.replace("[scene]", '[scene]\ngravity = ["0 m/s²", "-9.81 m/s²"]').replace(
        'circle = "0.2 mm"', 'circle = "0.2 mm"\nmass = "1 mg"'
    )
    poised = [
        finding["message"] for finding in check_report(load(desk.scene(text)), PAIRS)["findings"] if finding["code"] == "poised"
    ]
    assert [message.split()[0] for message in poised] == ["lever"]  # a driven wheel of equal teeth is poised


def test_text_for_people(desk):
    scene = load(desk.scene())
    text = check_text(check_report(scene, PAIRS), scene)
    assert text.startswith("Small lever\n")
    for part in (
        *("inertia 12 mg·cm²", "10 mm × 10 mm", "turned by -270°", "centre distance wheel - lever: 9 mm", "4 Hz = 28800 vph"),
        *("drive on wheel: -1 µN·m", "Q = 250", "contact wheel.TEETH - lever: friction 0.12, restitution 0.2"),
        "wheel - lever                   120               17                      3",
        "warning: wheel.dxf: an edge was drawn twice.",
    ):
        assert part in text, part
    assert "nothing overlaps at the start" in text


def test_a_mass_is_told_where_there_is_one(desk, good):
    weighed = good.replace('circle = "0.2 mm"', 'circle = "0.2 mm"\nmass = "1 mg"')
    bare, told = (
        check_text(check_report(scene, PAIRS), scene) for scene in (load(desk.scene(text)) for text in (good, weighed))
    )
    assert "mass" not in bare
    assert told.count("mass 1 mg") == 1


def test_what_is_carried_is_weighed_with_its_carrier_however_light(desk):
    """A balance of 40 mg on a carriage: together 140 mg, and what turns with the carriage is its inertia and m r²."""
    text = '[bodies.carriage]\nmass = "100 mg"\ninertia = "30 mg·cm²"\n[bodies.balance]\non = "carriage"\n'
    text += 'position = ["5 mm", "0 mm"]\nmass = "40 mg"\ninertia = "12 mg·cm²"\n'
    scene = load(desk.scene(text))
    words = check_text(check_report(scene, ()), scene)
    assert "with balance: mass 140 mg, inertia 40 mg·cm²" in words


# Is what a scene declares said in words with the right numbers, and what it leaves unsaid where it matters?

ARM = Body("arm", inertia=4e-9, mass=1e-3)  # 4 Hz on 1 uN·m/rad times (8 pi)² 4e-3
STIFF = 4e-9 * (8.0 * math.pi) ** 2
OTHER = Body("other", inertia=12e-9)
SLIDE = Body("slide", "slide", mass=2e-3)
WALL = Body("wall", "fixed")


def said(*bodies: Body, **forces: Any) -> list[str]:
    return [line.strip() for line in force_lines(Scene("said", bodies, **forces))]


def test_where_lengths_change_their_unit() -> None:
    assert [length(value) for value in (0.99e-4, 1.01e-4, 0.99, 1.01, 0.0, -0.5)] == [
        *("99 µm", "0.101 mm", "990 mm", "1.01 m", "0 m", "-500 mm")
    ]
    assert [place(value) for value in (1.23456789e-3, -4e-10, 1e-9, 0.6e-9, 0.4e-9, 0.1)] == [
        *("1.234568 mm", "0 mm", "0.000001 mm", "0.000001 mm", "0 mm", "100 mm")
    ]
    assert [turned(math.radians(value)) for value in (1e-9, 0.4e-9, -33.333333333)] == ["1e-09°", "0°", "-33.3333°"]


def noted(*bodies: Body, source: dict[str, object] | None = None, **forces: Any) -> list[str]:
    scene = Scene("noted", bodies, source={"bodies": source or {}}, **forces)
    return [one.code for one in notes(scene)]


DOWN: Any = {"gravity": (0.0, -9.81)}


@pytest.mark.parametrize(("off", "code"), [(0.9e-9, []), (1.1e-9, ["centre-of-mass"])])
def test_a_centre_of_mass_beside_the_pivot_by_a_billionth(off: float, code: list[str]) -> None:
    """Of the radius of gyration, here 3 mm: it must have been taken from the outline, and gravity must be there."""
    gyration = 3e-3
    body = Body("arm", mass=2e-3, inertia=2e-3 * gyration**2, centre_of_mass=(0.6 * off * gyration, -0.8 * off * gyration))
    written: dict[str, object] = {"arm": {"mass": "2 g", "inertia": "1 g·cm²"}}
    assert noted(body, source=written, **DOWN) == code
    assert noted(body, source=written) == []
    for more in ("solids", "centre_of_mass"):
        assert noted(body, source={"arm": {"mass": "2 g", "inertia": "1", more: 1}}, **DOWN) == []
    assert noted(body, source={"arm": {"mass": "2 g"}}, **DOWN) == [] == noted(body, source={"arm": {"inertia": "1"}}, **DOWN)
    assert noted(WALL, replace(body, on="wall"), source=written, **DOWN) == []
    assert noted(replace(body, motion="free"), source=written, **DOWN) == []


def test_what_has_no_mass() -> None:
    """Gravity does not turn it; what moves it does not feel it. A carrier without mass of its own weighs what it carries."""
    bare, rider = Body("bare", inertia=1e-9), Body("rider", inertia=1e-9, on="bare")
    assert noted(bare, **DOWN) == ["poised"] and noted(bare) == [] and noted(replace(bare, mass=1e-6), **DOWN) == []
    assert noted(bare, rider) == ["weightless"] and noted(bare, rider, **DOWN) == ["poised", "poised", "weightless"]
    assert noted(bare, replace(rider, mass=1e-6)) == [] and noted(WALL, replace(rider, on="wall")) == []
    assert noted(SLIDE, **DOWN) == []


def test_an_inertia_about_the_pivot_that_no_body_has() -> None:
    """2 g at 3 mm and 4 mm from the pivot: 50 mg·mm² at least, the same as that of a point mass."""
    body = Body("bob", mass=2e-3, inertia=50e-9, centre_of_mass=(3e-3, -4e-3))
    assert noted(body) == [] == noted(replace(body, inertia=60e-9))
    assert noted(replace(body, inertia=49e-9)) == ["inertia"] == noted(replace(body, inertia=5e-9))
    assert noted(replace(body, inertia=5e-9, motion="free")) == []


@pytest.mark.parametrize(("y", "codes"), [(30.9, []), (31.1, ["apart"])])
def test_a_contact_out_of_reach(desk: Any, y: float, codes: list[str]) -> None:
    """The tip of an arm of 30 mm and a pin of 1 mm: they meet where the pin is less than 31 mm away."""
    scene = load(
        desk.scene(
            '[bodies.arm]\npolygon = [["29 mm", "-1 mm"], ["30 mm", "0 mm"], ["29 mm", "1 mm"]]\ninertia = "1 g·cm²"\n'
            f'[bodies.stop]\nmotion = "fixed"\ncircle = "1 mm"\nposition = ["0 mm", "{y} mm"]\n'
            '[[contacts]]\nbetween = ["arm", "stop"]\n'
        )
    )
    assert [one.code for one in notes(scene)] == codes


def test_a_lift_angle_that_nothing_reads() -> None:
    spring, touching = (Spring("arm", STIFF),), (Contact((Side("arm"), Side("other"))),)
    assert noted(ARM, OTHER, lift_angle=0.9) == ["lift-angle"]
    arm = replace(ARM, angle=1.0)
    assert noted(arm, OTHER, lift_angle=0.9, springs=spring) == ["lift-angle"]
    assert noted(arm, OTHER, lift_angle=0.9, springs=spring, contacts=touching) == [] == noted(arm, OTHER, springs=spring)


@pytest.mark.parametrize(
    ("angle", "speed", "rests"), [(0.5, 0.0, True), (0.9, 0.9, True), (1.1, 0.0, False), (0.0, -1.1, False)]
)
def test_what_starts_at_rest(angle: float, speed: float, rests: bool) -> None:
    """Nearer to its rest position than a billionth of a radian, and slower than that a second."""
    body = replace(ARM, angle=0.3 + 1e-9 * angle, velocity=(1e-9 * speed,))
    assert noted(body, springs=(Spring("arm", STIFF, 0.3),)) == (["at-rest"] if rests else [])
    mirrored = replace(ARM, angle=-0.3 - 1e-9 * angle)
    assert noted(mirrored, springs=(Spring("arm", STIFF, -0.3),)) == (["at-rest"] if angle < 1.0 else [])
    slide = replace(SLIDE, angle=1.0)
    assert noted(slide, springs=(Spring("slide", 1.0, 0.5e-9),)) == ["at-rest"]
    assert noted(slide, springs=(Spring("slide", 1.0, 2e-9),)) == []
    touching: Any = {"torques": (Torque("other", 1e-6),), "contacts": (Contact((Side("arm"), Side("other"))),)}
    assert noted(body, OTHER, springs=(Spring("arm", STIFF, 0.3),), **touching) == []


# How is the law of a driven body put into words?


# Does a scene say aloud what it leaves unsaid, in run as in check, and no more than once?

HEAD = '[scene]\nschema = 1\ngravity = ["0 m/s²", "-9.81 m/s²"]\n'
FLAT = "[scene]\nschema = 1\n"
DISC = '[bodies.disc]\ncircle = "5 mm"\ninertia = "1 g·cm²"\n'
SPRING = '[[springs]]\nbody = "disc"\nfrequency = "4 Hz"\n'
END = '[run]\nduration = "0.01 s"\n'
BOB = """<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60">
<rect id="PALLETS" x="1" y="1" width="9" height="2"/><rect id="ROD" x="5" y="3" width="1" height="40"/>
<circle id="BOB" cx="5" cy="45" r="5"/><circle id="PIVOT" cx="5" cy="-5" r="4"/></svg>"""
CASES = {
    "gravity without a mass": (HEAD + DISC + END, "poised", "disc has no mass, so gravity does not turn it"),
    "mass beside inertia": (
        HEAD + DISC.replace("inertia", 'angle = "9°"\npivot = ["0 mm", "2 mm"]\nmass = "1 g"\ninertia') + END,
        "centre-of-mass",
        "taken from its outline as of a uniform plate, 2 mm beside the pivot",
    ),
    "mass of a drawing of which a part counts": (
        FLAT + '[bodies.bob]\ndrawing = "bob.svg"\nlayers = ["PALLETS"]\nmass = "1 g"\nangle = "9°"\n' + END,
        "mass-by-layer",
        "the mass of bob is spread over what can touch, PALLETS: ROD and BOB count for nothing",
    ),
    "a lift angle that nothing hears": (
        FLAT + DISC.replace("inertia", 'angle = "9°"\ninertia') + SPRING + '[timegrapher]\nlift_angle = "50°"\n' + END,
        "lift-angle",
        "nothing may touch disc, so no beat is heard",
    ),
    "a lift angle without an oscillator": (
        FLAT + DISC + '[timegrapher]\nlift_angle = "50°"\n' + END,
        "lift-angle",
        "nothing swings on a spring or by gravity",
    ),
    "a clock that hangs still": (FLAT + DISC + SPRING + END, "at-rest", "disc starts at rest in its rest position"),
}


@pytest.mark.parametrize("name", CASES)
def test_said_by_check_and_by_run_once(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text, code, words = CASES[name]
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    (tmp_path / "bob.svg").write_text(BOB, encoding="utf-8")
    assert [note.code for note in notes(load(tmp_path))] == [code]
    assert main(["check", str(tmp_path)]) == FINE
    assert capsys.readouterr().out.count(words) == 1
    assert main(["run", str(tmp_path), "--no-plots", "-o", str(tmp_path / "out")]) == FINE
    said = capsys.readouterr()
    assert said.err.count(words) == 1 and words not in said.out
    assert words in (tmp_path / "out" / "report.txt").read_text(encoding="utf-8")
    (note,) = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["notes"]
    assert words in note


def test_nothing_is_said_of_what_is_plain(tmp_path: Path) -> None:
    for text in (
        FLAT + DISC + END,
        FLAT + DISC.replace("inertia", 'mass = "1 g"\npivot = ["0 mm", "2 mm"]\ninertia') + END,
        HEAD + DISC.replace("inertia", 'mass = "1 g"\ninertia') + END,
        FLAT + DISC.replace("inertia", 'velocity = "10 °/s"\ninertia') + SPRING + END,
        *(FLAT + DISC.replace("inertia", f'angle = "{side}9°"\ninertia') + SPRING + END for side in ("", "-")),
    ):
        (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
        assert notes(load(tmp_path)) == ()


@pytest.mark.parametrize(
    ("scene", "key", "value", "why"),
    [
        (FLAT + DISC, "amplitude", "1°", "nothing in it swings on a spring or by gravity"),
        (FLAT + DISC + SPRING, "missed_beats", 0, "no driven wheel keeps the oscillator going"),
        (FLAT + DISC + SPRING, "timegrapher.amplitude_deg", "1°", "it names no lift_angle under"),
        (FLAT + DISC + SPRING + '[timegrapher]\nlift_angle = "9°"\n', "timegrapher.interval_ms", "1 ms", "no beat is heard"),
    ],
)
def test_an_expectation_that_the_scene_cannot_give(
    scene: str, key: str, value: object, why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    unit = "" if isinstance(value, int) else '"1 ms"' if "ms" in str(value) else '"1°"'
    shown = f'"{value}"' if isinstance(value, str) else value
    text = scene + f'[expect]\n"{key}" = {{ value = {shown}, tolerance = {unit or 1} }}\n'
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    for command in (["check", str(tmp_path)], ["run", str(tmp_path), "-o", str(tmp_path / "out")]):
        assert main(command) == BAD_INPUT
        said = capsys.readouterr().err
        assert f'no run of this scene gives "{key}"' in said and why in said
    assert not (tmp_path / "out").exists()


def test_values_choose_their_prefix(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = HEAD + (
        '[bodies.bar]\npolygon = [["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["1 mm", "2000 mm"], ["-1 mm", "2000 mm"]]\n'
        'mass = "5000 kg"\n[bodies.tiny]\ncircle = "1 mm"\nposition = ["3.71e-6 mm", "2 mm"]\ninertia = "1 mg·cm²"\n'
        '[[damping]]\nbody = "tiny"\nviscous = "1e-9 nN·m·s/rad"\n'
    )
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path)]) == FINE
    said = capsys.readouterr().out
    assert "1 m beside the pivot: gravity turns it with up to 49.05 kN·m" in said
    assert "e-0" not in said.replace("e-06 ", "") and "e+" not in said
    assert "at (0.000004 mm, 2 mm)" in said


# Are lengths written in the unit that suits them, and do tables stand in columns?


# Are declared, reachable and candidate pairs counted for each pair of bodies?

PROFILES = Path(__file__).resolve().parents[2] / "profiles"


def counted(scene):
    return modelled_pairs(compile_scene(scene), [body.name for body in scene.bodies])


@pytest.mark.parametrize("name", ["bench_lever", "swiss_lever", "carriage"])
def test_every_pair_of_bodies_is_counted_and_candidates_are_few(name):
    scene = ws.load(PROFILES / name / "scene.toml")
    compiled, pairs = compile_scene(scene), counted(scene)
    assert {frozenset(count.bodies) for count in pairs.counts} == {
        frozenset(side.body for side in contact.sides) for contact in scene.contacts
    }
    assert sum(count.declared for count in pairs.counts) == len(compiled.model.contacts)
    for count in pairs.counts:
        assert 0 < count.typical <= count.most <= count.reachable <= count.declared and count.start <= count.most
    wheel = next(count for count in pairs.counts if "wheel" in count.bodies)
    assert wheel.most < wheel.reachable / 20


@pytest.mark.parametrize("name", ["swiss_lever", "carriage", "coaxial", "geneva", "graham"])
def test_where_only_what_comes_near_is_listed_the_same_is_near(name, monkeypatch):
    """As of outlines of thousands of edges, of which all pairs would take gigabytes."""
    scene = ws.load(PROFILES / name)
    whole = compile_scene(scene)
    monkeypatch.setattr("watchsim.mechanism.contacts.MOST_LISTED", 0)
    monkeypatch.setattr("watchsim.mechanism.contacts.SLAB", 1000)
    few = compile_scene(replace(scene))
    assert len(few.model.near) <= len(few.model.contacts) < len(whole.model.contacts)
    assert few.declared == whole.declared
    assert few.model.contacts[few.model.near].tolist() == whole.model.contacts[whole.model.near].tolist()


def polygon(corners: int) -> list[str]:
    """A wavy disc of 5 mm."""
    turns = [2.0 * math.pi * i / corners for i in range(corners)]
    far = [5.0 + 0.5 * math.cos(15.0 * turn) for turn in turns]
    return [f'["{r * math.cos(turn):.6f} mm", "{r * math.sin(turn):.6f} mm"]' for r, turn in zip(far, turns, strict=True)]


def test_two_outlines_of_thousands_of_edges_are_listed_where_they_meet(tmp_path, capsys):
    corners = ", ".join(polygon(2200))
    bodies = "".join(
        f'[bodies.{name}]\npolygon = [{corners}]\nposition = ["{x} mm", "0 mm"]\ninertia = "1 mg·cm²"\n'
        for name, x in (("one", 0), ("other", 10.97))
    )
    text = f'[scene]\ntitle = "two"\nschema = 1\n{bodies}[[contacts]]\nbetween = ["one", "other"]\n[run]\nduration = "1 ms"\n'
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path), "--json"]) == FINE
    pairs = json.loads(capsys.readouterr().out)["pairs"]
    assert pairs["declared"] > 5_000_000
    assert 0 < pairs["reachable"] < len(compile_scene(ws.load(tmp_path)).model.contacts) < 200_000


def test_edges_of_outlines_that_touch_at_the_start_are_candidates():
    """Outlines are laid into the plane by shapely here; every body that touches another must have a candidate edge there."""
    scene = ws.load(PROFILES / "swiss_lever" / "scene.toml")
    compiled, pairs = compile_scene(scene), counted(scene)
    primitives = compiled.model.primitives[pairs.candidates]
    near = 1e-9
    met = 0
    for (i, one), (k, other) in itertools.combinations(enumerate(scene.bodies), 2):
        shapes = [
            translate(rotate(shapely.MultiLineString([polyline(loop, 1e-8) for loop in body.loops]), body.angle, (0, 0), True),
                      *body.position) for body in (one, other)
        ]  # fmt: skip
        if shapes[0].distance(shapes[1]) > near or not any({one.name, other.name} == set(c.bodies) for c in pairs.counts):
            continue
        met += 1
        assert {i, k} <= set(primitives.body.tolist())
    assert met >= 1
    assert set(pairs.candidates) <= set(pairs.reachable)


def test_a_ball_above_the_middle_of_a_floor_has_no_candidates_yet():
    """Far from everything nothing is a candidate, although everything can be reached."""
    scene = ws.load(PROFILES / "swiss_lever" / "scene.toml").set("bodies.lever.angle", "170 deg")
    wheel = next(count for count in counted(scene).counts if "wheel" in count.bodies)
    assert wheel.start == 0 < wheel.reachable


def test_without_the_prefilter_every_contact_is_near():
    scene = ws.load(PROFILES / "bench_lever" / "scene.toml")
    sifted, whole = compile_scene(scene).model, compile_scene(scene, prefilter=False).model
    assert sifted.pairs.listed.any() and len(sifted.near) < len(sifted.contacts)
    assert not whole.pairs.listed.any()
    assert whole.near.tolist() == list(range(len(whole.contacts)))
    assert whole.pairs.near_start.tolist() == whole.pairs.start.tolist()
    assert whole.pairs.near_stop.tolist() == whole.pairs.stop.tolist()


@pytest.mark.parametrize(("radius", "away"), [("20 µm", "30 mm"), ("0.1 mm", "300 mm"), ("1 mm", "20 m")])
def test_a_disc_far_from_a_drawn_lever_is_checked(radius, away, tmp_path, capsys):
    """So many of its own sizes away there are no cells; everything that can touch is a candidate, as in a run."""
    (tmp_path / "scene.toml").write_text(
        f'''[bodies.lever]
drawing = "{PROFILES / "swiss_lever" / "lever.dxf"}"
motion = "fixed"
[bodies.disc]
circle = "{radius}"
motion = "free"
position = ["{away}", "0 mm"]
mass = "1 mg"
inertia = "1 mg·mm²"
[[contacts]]
between = ["disc", "lever"]
''',
        encoding="utf-8",
    )
    assert main(["check", str(tmp_path)]) == 0
    (count,) = counted(ws.load(tmp_path)).counts
    assert count.start == count.typical == count.most == count.reachable > 16
    assert "disc" in capsys.readouterr().out
