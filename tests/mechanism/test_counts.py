"""Are declared, reachable and candidate pairs counted for each pair of bodies?"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely.affinity import rotate, translate

import watchsim as ws
from watchsim.cli import main
from watchsim.geometry.polyline import polyline
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.count_pairs import modelled_pairs
from watchsim.mechanism.pair_table import PairCount, pair_lines, pairs_entry

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


def test_a_table_for_people():
    counts = [PairCount(("wheel", "lever"), 12345, 700, 3, 9, 2), PairCount(("lever", "banking"), 16, 4, 4, 4, 4)]
    text = "\n".join(pair_lines(pairs_entry(counts)))
    assert "12,345" in text and "12,361" in text and "704" in text
    assert [line.split()[-1] for line in text.splitlines()[1:]] == ["3", "4", "7"]
    assert "together" not in "\n".join(pair_lines(pairs_entry(counts[:1])))
    assert "no contact" in "\n".join(pair_lines(pairs_entry([])))


def test_sums_for_json():
    counts = [PairCount(("a", "b"), 10, 7, 3, 4, 2), PairCount(("b", "c"), 20, 8, 1, 1, 1)]
    entry = pairs_entry(counts)
    assert (entry["declared"], entry["reachable"], entry["typical"]) == (30, 15, 4)
    assert entry["between"][0] == {"bodies": ["a", "b"], "declared": 10, "reachable": 7, "typical": 3, "most": 4, "start": 2}
    assert np.all([set(row) == set(PairCount._fields) for row in entry["between"]])


def test_without_the_prefilter_every_contact_is_near():
    scene = ws.load(PROFILES / "bench_lever" / "scene.toml")
    sifted, whole = compile_scene(scene).model, compile_scene(scene, prefilter=False).model
    assert sifted.pairs.listed.any() and len(sifted.near) < len(sifted.contacts)
    assert not whole.pairs.listed.any()
    assert whole.near.tolist() == list(range(len(whole.contacts)))
    assert whole.pairs.near_start.tolist() == whole.pairs.start.tolist()
    assert whole.pairs.near_stop.tolist() == whole.pairs.stop.tolist()
