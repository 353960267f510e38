"""Does the JSON Schema accept what the program reads, and refuse what it can of what the program refuses?"""

import json
import re
from pathlib import Path

import pytest
from jsonschema import Draft4Validator

from watchsim import units
from watchsim.cli import main
from watchsim.construction.registry import names
from watchsim.designs import Maker
from watchsim.paths import profiles_dir
from watchsim.scene.designed import designed
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping
from watchsim.scene.schema import FILE, HEADER, schema
from watchsim.scene.toml import parsed

SCHEMA = schema()
JUDGE = Draft4Validator(SCHEMA)
VALID = sorted([*profiles_dir().glob("*/*.toml"), *Path(__file__).parents[1].glob("records/scenes/*.toml")])
GOOD = """
[bodies.wheel]
circle = "2 mm"
inertia = "0.05 mg·cm²"
[bodies.stop]
circle = "1 mm"
position = ["0 mm", "4 mm"]
motion = "fixed"
[[springs]]
body = "wheel"
frequency = "4 Hz"
[[torques]]
body = "wheel"
value = "-1 µN·m"
[[contacts]]
between = ["wheel", "stop"]
friction = 0.1
[run]
duration = "1 s"
"""


def test_it_is_a_schema_of_draft_4():
    assert list(Draft4Validator(Draft4Validator.META_SCHEMA).iter_errors(SCHEMA)) == []


@pytest.mark.parametrize("path", VALID, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_every_profile_and_record_is_valid(path):
    assert [error.message for error in JUDGE.iter_errors(parsed(path.read_text(encoding="utf-8")))] == []


@pytest.mark.parametrize("name", names())
def test_every_design_is_valid(name):
    text = Maker(designed(name))().files(drawings=False)["scene.toml"].decode()
    assert [error.message for error in JUDGE.iter_errors(parsed(text))] == []


REFUSED = [
    ('circle = "2 mm"', 'cirle = "2 mm"'),  # a key that is not known
    ('circle = "2 mm"', 'circle = "2 mg"'),  # a unit of another kind
    ('circle = "2 mm"', 'circle = "2 furlong"'),  # no unit
    ('circle = "2 mm"', "circle = 2"),  # a bare number
    ('circle = "2 mm"', 'circle = "-2 mm"'),  # out of its limits
    ('circle = "2 mm"', 'circle = "0 mm"'),
    ('circle = "2 mm"', 'circle = "2,5 mm"'),  # a decimal comma
    ('inertia = "0.05 mg·cm²"', 'inertia = "0.05 mg"'),
    ('["0 mm", "4 mm"]', '["0 mm"]'),  # one value of two
    ('motion = "fixed"', 'motion = "fxed"'),  # no choice
    ('motion = "fixed"', 'motion = "fixed"\naxis = [1.0, 0.0]'),  # for another motion
    ('frequency = "4 Hz"', 'frequency = "4 Hz"\nstiffness = "1 µN·m/rad"'),  # said twice
    ('[[springs]]\nbody = "wheel"', "[[springs]]"),  # a key that is needed
    ("[[torques]]", "[torques]"),  # a table in place of a list
    ("[run]", "[runs]"),  # a table that is not known
    ("friction = 0.1", "friction = -0.1"),
    ("friction = 0.1", 'friction = "0.1 mm"'),
    ("friction = 0.1", "friction = 0.1\nrestitution = 1.5"),
    ('["wheel", "stop"]', '"wheel"'),
    ('duration = "1 s"', 'duration = "1 m"'),
]
NOT_SAID = [  # what relates tables, bodies and drawings
    ('body = "wheel"\nfrequency', 'body = "whel"\nfrequency'),
    ('inertia = "0.05 mg·cm²"', ""),
    ('"4 mm"]', '"2.5 mm"]\nangle = "1 rad"\nvelocity = "1 rad/s"'),
]


def _refused(text: str) -> bool:
    try:
        from_mapping(parsed(text), None)
    except SceneError:
        return True
    return False


def test_a_sound_scene_is_valid_for_both():
    assert JUDGE.is_valid(parsed(GOOD)) and not _refused(GOOD)


@pytest.mark.parametrize(("old", "new"), REFUSED)
def test_what_is_wrong_by_itself_is_refused_by_both(old, new):
    text = GOOD.replace(old, new, 1)
    assert text != GOOD and _refused(text)
    assert not JUDGE.is_valid(parsed(text))


@pytest.mark.parametrize(("old", "new"), NOT_SAID)
def test_what_relates_tables_is_left_to_the_reader(old, new):
    text = GOOD.replace(old, new, 1)
    assert text != GOOD and _refused(text)
    assert JUDGE.is_valid(parsed(text))


def test_dimensions_of_a_design_are_known():
    assert JUDGE.is_valid({"design": {"of": "swiss_lever", "lock": "2°", "teeth": 20}})
    for wrong in ({"lok": "2°"}, {"lock": 2}, {"lock": "2 mm"}, {"teeth": 20.5}, {"teeth": 3}):
        assert not JUDGE.is_valid({"design": {"of": "swiss_lever", **wrong}}), wrong
    assert JUDGE.is_valid({"design": {"of": "of_another_package", "length": "2 m"}})


NAMES = "mm µm μm um in inch m s ms min h d ° deg rad rev % ppm kg mg g Hz vph A/h N mN Nm GPa"
PRODUCTS = "µN·m mg·cm² µN·m/rad g/cm³ °/s mm/s m/s²"


@pytest.mark.parametrize("kind", units.DIMENSIONS, ids=lambda kind: kind.name)
def test_what_the_reader_takes_for_a_quantity_matches(kind):
    for unit in ("", *NAMES.split(), *PRODUCTS.split(), *kind.usual, kind.si):
        text, taken = f"−1.5e3 {unit}", True
        try:
            units.parse(text, kind)
        except units.UnitError:
            taken = False
        matches = re.search(units.pattern(kind), text) is not None
        assert matches or not taken, text
        assert taken or not matches or re.search("[·/²³]", unit), text  # of products a pattern does not know what they measure


def test_the_command_prints_it_and_new_writes_it_beside_a_scene(tmp_path, capsys):
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == SCHEMA
    assert main(["schema", "-o", str(tmp_path / "all.json")]) == 0
    assert json.loads((tmp_path / "all.json").read_text(encoding="utf-8")) == SCHEMA
    assert main(["new", "swiss_lever", "-o", str(tmp_path / "a")]) == 0
    text = (tmp_path / "a" / "scene.toml").read_text(encoding="utf-8")
    assert text.startswith(HEADER) and HEADER.split()[1] == FILE
    beside = json.loads((tmp_path / "a" / FILE).read_text(encoding="utf-8"))
    assert Draft4Validator(beside).is_valid(parsed(text))
    assert not Draft4Validator(beside).is_valid(parsed(text.replace("embraced ", "embrased ")))


def test_paths_of_a_scene_can_be_set(tmp_path, capsys):
    assert main(["new", "swiss_lever", "-o", str(tmp_path / "a")]) == 0
    capsys.readouterr()
    assert main(["schema", "--paths", str(tmp_path / "a"), "--json"]) == 0
    paths = json.loads(capsys.readouterr().out)
    assert paths["design.lock"] == "1.5°" and paths["contacts.0.friction"] == 0.12
    assert main(["schema", "--paths", str(tmp_path / "nowhere")]) == 2
