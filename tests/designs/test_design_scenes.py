"""What does a scene say that is made from a design, and does it stay what it is in a results folder?"""

import math

import pytest

import watchsim as ws
from watchsim import designs
from watchsim.results.folder import travelling
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

DESIGN = '[design]\nof = "swiss_lever"\nlock = "2°"\n'


def write(folder, text):
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    return load(folder)


def test_files_and_memory_hold_the_same_scene(tmp_path):
    mine = designs.swiss_lever(lock="2°")
    mine.write(tmp_path / "lever")
    assert load(tmp_path / "lever") == mine.scene() == write(tmp_path, DESIGN)


def test_a_dimension_is_a_key_like_any_other(tmp_path):
    scene = write(tmp_path, DESIGN)
    deeper = scene.set("design.lock", "2.2°")
    assert deeper.body("lever").angle - scene.body("lever").angle == pytest.approx(math.radians(0.1))
    assert deeper == scene.set("design.lock", math.radians(2.2))
    assert deeper == designs.swiss_lever(lock="2.2°").scene()
    assert deeper.set("design.lock", "2°") == scene
    assert deeper.set("design.teeth", 16).title == "Swiss lever, 28800 vph, 16 teeth"


def test_other_changes_stay_when_a_dimension_changes(tmp_path):
    scene = write(tmp_path, DESIGN).set("torques.0.value", "-1.3 µN·m").set("design.lock", "1°")
    assert scene.torques[0].value == -1.3e-6
    assert scene.set("contacts.0.friction", 0.2).torques[0].value == -1.3e-6


def test_the_file_writes_over_the_design(tmp_path):
    over = """
[scene]
title = "Mine"
[[torques]]
body = "wheel"
over = "time"
table = [["0 s", "0 µN·m"], ["1 s", "-1 µN·m"]]
[[damping]]
body = "balance"
coulomb = "1 nN·m"
[[contacts]]
between = ["lever.STONES", "wheel.TEETH"]
friction = 0.3
[bodies.lever]
inertia = "0.04 mg·cm²"
[bodies.stop]
circle = "0.1 mm"
position = ["-5 mm", "0 mm"]
motion = "fixed"
[[contacts]]
between = ["wheel.TEETH", "stop"]
"""
    scene = write(tmp_path, DESIGN + over)
    assert scene.title == "Mine"
    assert [torque.over for torque in scene.torques] == ["time"]
    assert scene.damping[0].coulomb == 1e-9
    assert scene.damping[0].viscous > 0.0, "the quality factor of the design stays"
    assert [contact.friction for contact in scene.contacts] == [0.3, 0.12, 0.12, 0.12, 0.0]
    assert scene.contacts[0].restitution == 0.2
    assert scene.body("lever").inertia == pytest.approx(4e-12)
    assert scene.body("stop").motion == "fixed"


def test_a_results_folder_holds_the_drawings(tmp_path):
    scene = write(tmp_path, DESIGN + '[bodies.lever.adjust]\nSTONES = { turn = "0.01°" }\n').set("design.draw", "14°")
    files = travelling(scene)
    assert sorted(files) == [
        *(f"drawings/{name}.dxf" for name in ("banking", "escape_wheel", "lever", "roller")),
        "scene.lock.toml",
    ]
    kept = tmp_path / "kept"
    (kept / "drawings").mkdir(parents=True)
    for name, content in files.items():
        (kept / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    again = load(kept)
    assert again == scene
    assert again.source["lock"]["design"]["draw"] == "14°"


def test_a_run_goes_on_from_its_results(tmp_path):
    scene = write(tmp_path, DESIGN)
    whole = ws.simulate(scene, duration=0.06)
    half = ws.simulate(scene, duration=0.03)
    ws.write_results(half, tmp_path / "half")
    back = ws.read_results(tmp_path / "half")
    assert (ws.simulate(back.scene, duration=0.06, start=back).end_q == whole.end_q).all()


FAULTS = [
    ('[design]\nof = "swiss_lever"\nlok = "2°"\n', ":3  design.lok", 'Did you mean "lock"?'),
    ('[design]\nof = "swiss_lever"\nlock = "9°"\ndraw = "1°"\n', ":4  design.draw", "must be from 5° to 25°"),
    ('[design]\nof = "swiss_lever"\nlock = 2\n', ":3  design.lock", "a bare number needs a unit"),
    ('[design]\nof = "swis_lever"\n', ":2  design.of", 'Did you mean "swiss_lever"?'),
    ('[design]\nlock = "2°"\n', ":1  design.of", "missing. Known: "),
    ("design = 3\n", ":1  design", "a table is needed"),
    ('[design]\nof = "swiss_lever"\nteeth = 30\n', "design.drop_inside = 1.2° (default)", "leave 0.3° for the stone"),
    ('[design]\nof = "swiss_lever"\n[[torques]]\nbody = "weel"\nvalue = "1 µN·m"\n', "torques.1.body", "wheel"),
    (DESIGN + '[[contacts]]\nbetween = ["lever.STONES", ["wheel.TEETH"]]\n', "contacts.4.between", "two sides are needed"),
    (DESIGN + "bodies = 3\n", "design.bodies", "unknown dimension"),
]


@pytest.mark.parametrize(("text", "place", "words"), FAULTS)
def test_faults_name_the_line_and_the_reason(tmp_path, text, place, words):
    with pytest.raises(SceneError) as caught:
        write(tmp_path, text)
    assert place in str(caught.value)
    assert words in str(caught.value)


def test_python_lists_the_dimensions():
    import inspect

    assert designs.names() == dir(designs)[:-1] or set(designs.names()) < set(dir(designs))
    maker = ws.designs.swiss_lever
    assert inspect.signature(maker).parameters["lock"].default == "1.5°"
    assert "lock = 1.5°  (0.1° to 4°): lever, from the drop" in maker.__doc__
    with pytest.raises(AttributeError, match="known are swiss_lever"):
        _ = designs.swis_lever
    with pytest.raises(SceneError, match="unknown dimension"):
        maker(lok="2°")


def test_a_folder_that_exists_is_left_alone(tmp_path):
    mine = designs.swiss_lever()
    (tmp_path / "lever").mkdir()
    (tmp_path / "lever" / "note.txt").write_text("mine")
    with pytest.raises(FileExistsError, match="was not changed"):
        mine.write(tmp_path / "lever")
    mine.write(tmp_path / "lever", force=True)
    assert (tmp_path / "lever" / "note.txt").read_text() == "mine"


def test_a_dimension_that_makes_another_one_impossible_is_refused_with_how_far_it_may_go():
    """The default of the guard's freedom is in the way of wide pins: what was given is to change."""
    with pytest.raises(SceneError, match=r"design.pallet_pin.*\n.*works up to 0\.371 mm"):
        designs.pin_pallet(pallet_pin="0.5 mm")
    assert designs.pin_pallet(pallet_pin="0.371 mm").scene()
    with pytest.raises(SceneError):
        designs.pin_pallet(pallet_pin="0.373 mm")
