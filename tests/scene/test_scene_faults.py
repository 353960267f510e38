"""Is every kind of bad scene refused with file, line, key and cure, all faults at once?"""

import sys

import pytest
from made_scenes import drawing, square

import watchsim as ws
from watchsim.cli import main
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping, load, read_mapping

POLYGON = 'polygon = [["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "3 mm"]]'
SOLID = '[[bodies.wheel.solids]]\nlayer = "TEETH"\nthickness = "0.12 mm"\ndensity = "7.85 g/cm³"\n'
WHEEL_INERTIA = 'inertia = "0.05 mg·cm²"\n'


def faults_of(desk, text):
    with pytest.raises(SceneError) as caught:
        load(desk.scene(text))
    return caught.value.faults


# (what stands in the good scene, what replaces it, key of the only fault, part of its message)
ONE_FAULT = [
    ('drawing = "wheel.dxf"', 'drawng = "wheel.dxf"', None, None),
    ("[scene]", "[scen]", "scen", 'unknown section. Did you mean "scene"?'),
    ('title = "Small lever"', "title = 5", "scene.title", "a text in quotes is needed here."),
    ('title = "Small lever"', "schema = 2", "scene.schema", "this version of watchsim reads schema 1."),
    ('title = "Small lever"', "gravity = 9.81", "scene.gravity", "two values are needed here"),
    ('title = "Small lever"', 'tangential_law = "newton"', "scene.tangential_law", "not one of coulomb, pg1996, shifted"),
    ('title = "Small lever"', "nu = 0.5", "scene.nu", "belongs to tangential_law"),
    ('title = "Small lever"', 'tangential_law = "pg1996"\nnu = 2', "scene.nu", "must lie between 0 and 1"),
    ("duration =", "duratoin =", "run.duratoin", 'unknown key. Did you mean "duration"?'),
    (
        'drawing = "wheel.dxf"',
        'drawing = "wheels.dxf"',
        "bodies.wheel.drawing",
        'there is no such file. Did you mean "wheel.dxf"?',
    ),
    ('drawing = "wheel.dxf"', 'drawing = "nope.dxf"', "bodies.wheel.drawing", "there is no such file. Known here: "),
    ('drawing = "wheel.dxf"', 'drawing = ""', "bodies.wheel.drawing", "the name of a drawing is needed here: wheel.dxf."),
    ('drawing = "wheel.dxf"', "drawing = 3", "bodies.wheel.drawing", "a text in quotes"),
    (
        'layers = ["TEETH"]',
        'layers = "TEETH"',
        "bodies.wheel.layers",
        'a list of texts is needed here, such as layers = ["TEETH"]',
    ),
    ('layers = ["TEETH"]', 'layers = ["TEETH", "TEETHS"]', "bodies.wheel.layers.1", "wheel.dxf has TEETH, BORE, PIVOT."),
    ('layers = ["TEETH"]', 'layers = ["TEETH", "PIVOT"]', "bodies.wheel.layers.1", "no closed outline on this layer"),
    ('pivot = "PIVOT"', 'pivot = "PIVOTS"', "bodies.wheel.pivot", 'Did you mean "PIVOT"? wheel.dxf has'),
    ('pivot = "PIVOT"', 'pivot = "TEETH"', "bodies.wheel.pivot", "neither a point nor a circle is on this layer"),
    ('pivot = "PIVOT"', 'pivot = ["3 mm"]', "bodies.wheel.pivot", "two values are needed here"),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\nsnap = "0 mm"', "bodies.wheel.snap", "must be above zero"),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\nmotion = "pivto"', "bodies.wheel.motion", 'Did you mean "pivot"?'),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\naxis = [1.0, 0.0]', "bodies.wheel.axis", 'belongs to motion = "slide"'),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\nspin = "1 rad/s"', "bodies.wheel.spin", 'belongs to motion = "free"'),
    (
        'pivot = "PIVOT"',
        'pivot = "PIVOT"\non = "carriage"',
        "bodies.wheel.on",
        "there is no such body. Known here: lever, balance, banking",
    ),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\nadjust = 3', "bodies.wheel.adjust", "a table of layers is needed here"),
    ('pivot = "PIVOT"', 'pivot = "PIVOT"\ncircle = "1 mm"', "bodies.wheel.circle", "one outline: leave out circle or drawing"),
    (WHEEL_INERTIA, "", "bodies.wheel", "the body can move (pivot) but has no inertia"),
    (WHEEL_INERTIA, 'inertia = "0 mg·cm²"\n', "bodies.wheel.inertia", "the body can move (pivot) but has no inertia"),
    (WHEEL_INERTIA, 'inertia = "-1 mg·cm²"\n', "bodies.wheel.inertia", "must not be negative"),
    (WHEEL_INERTIA, 'inerti = "0.05 mg·cm²"\n', "bodies.wheel.inerti", 'unknown key. Did you mean "inertia"?'),
    ("restitution = 0.2", "restitution = true", "contacts.0.restitution", "a plain number is needed here, not true or false"),
    (WHEEL_INERTIA, "inertia = 5e-12\n", "bodies.wheel.inertia", "a bare number needs a unit here"),
    (WHEEL_INERTIA, 'inertia = "nan mg·cm²"\n', "bodies.wheel.inertia", "does not begin with a number"),
    (WHEEL_INERTIA, SOLID.replace('density = "7.85 g/cm³"\n', ""), "bodies.wheel.solids.0", "density is missing"),
    (WHEEL_INERTIA, SOLID.replace("TEETH", "HUB"), "bodies.wheel.solids.0.layer", "closed outlines on: TEETH, BORE"),
    (WHEEL_INERTIA, 'mass = "1 mg"\n' + SOLID, "bodies.wheel.mass", "the solids give the mass already"),
    (POLYGON, 'polygon = [["0 mm", "0 mm"], ["1 mm", "0 mm"]]', "bodies.lever.polygon", "a list of at least 3 points"),
    (POLYGON, POLYGON.replace('"3 mm"', "3"), "bodies.lever.polygon.2.1", "a bare number needs a unit here"),
    (POLYGON, POLYGON.replace('["0 mm", "3 mm"]', '["0 mm"]'), "bodies.lever.polygon.2", "two values are needed"),
    (POLYGON, POLYGON.replace("3 mm", "0 mm"), "bodies.lever.polygon", "it encloses no area"),
    (POLYGON, POLYGON.replace('["0 mm", "3 mm"]', '["1 mm", "0 mm"]'), "bodies.lever.polygon", "a point occurs twice in it"),
    (
        POLYGON,
        'polygon = [["0 mm", "0 mm"], ["2 mm", "2 mm"], ["2 mm", "0 mm"], ["0 mm", "3 mm"]]',
        "bodies.lever.polygon",
        "its sides 0 and 2 (counted from 0) cross each other",
    ),
    (POLYGON, POLYGON + '\nlayers = ["A"]', "bodies.lever.layers", "belongs to a drawing; this body is a polygon"),
    (POLYGON, POLYGON + '\npivot = "PIVOT"', "bodies.lever.pivot", "without a drawing there is no layer"),
    (POLYGON, 'line = [["0 mm", "0 mm"], ["0 mm", "0 mm"]]', "bodies.lever.line", "its two points are the same"),
    ('circle = "0.1 mm"', 'circle = "-0.1 mm"', "bodies.banking.circle", "must be above zero: it is the radius"),
    ('motion = "fixed"', 'motion = "fixed"\nvelocity = "1 °/s"', "bodies.banking.velocity", "a fixed body does not move"),
    ('motion = "fixed"', 'motion = "slide"\nmass = "1 g"', "bodies.banking", "a sliding body needs its direction"),
    ('motion = "fixed"', 'motion = "slide"\nmass = "1 g"\naxis = [0, 0]', "bodies.banking.axis", "points nowhere"),
    ('motion = "fixed"', 'motion = "slide"\naxis = [1, 0]', "bodies.banking", "has no mass"),
    (
        'velocity = "360 °/s"',
        'velocity = "4 Hz"',
        "bodies.balance.velocity",
        "is a frequency; here an angular velocity is needed",
    ),
    (
        'frequency = "28800 vph"',
        "frequency = 28800",
        "springs.0.frequency",
        '28800 Hz and 28800 vph differ by a factor of 7200. Write "28800 vph".',
    ),
    ('frequency = "28800 vph"', 'frequency = "4 Hz"\nstiffness = "1 N·m/rad"', "springs.0.frequency", "leave one out"),
    ('frequency = "28800 vph"', "", "springs.0", 'a spring needs frequency = "28800 vph" or stiffness'),
    ('frequency = "28800 vph"', 'frequency = "0 Hz"', "springs.0.frequency", "must be above zero"),
    ('frequency = "28800 vph"', 'stiffness = "1 N/m"', "springs.0.stiffness", "here a rotary stiffness is needed"),
    ('body = "balance"\nfreq', 'body = "balnce"\nfreq', None, None),
    ('body = "wheel"\nvalue', 'body = "banking"\nvalue', "torques.0.body", 'and motion of banking is "fixed"'),
    ('body = "wheel"\nvalue', "value", "torques.0.body", 'missing. Write e.g. body = "wheel"'),
    ('value = "-1.0 µN·m"', "", "torques.0", 'missing: value = "-1.0 µN·m", or a table'),
    ('value = "-1.0 µN·m"', 'value = "-1.0 µN·m"\nover = "time"', "torques.0.over", "belongs to a table"),
    ('value = "-1.0 µN·m"', 'table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]]', None, None),
    ('value = "-1.0 µN·m"', 'over = "time"\ntable = [["1 s", "0 N·m"], ["1 s", "1 N·m"]]', "torques.0.table.1", "must ascend"),
    ('value = "-1.0 µN·m"', 'over = "time"\ntable = [["1 s", "0 N·m"]]', "torques.0.table", "at least two pairs"),
    ('value = "-1.0 µN·m"', 'over = "time"\ntable = [["0 s", "0 N·m"], ["1 s", 3]]', "torques.0.table.1.1", "a bare number"),
    ("q_factor = 250", "q_factor = -3", "damping.0.q_factor", "must be above zero"),
    ("q_factor = 250", 'q_factor = 250\nviscous = "1 nN·m·s/rad"', "damping.0.q_factor", "leave one out"),
    ("q_factor = 250", 'viscous = "-1 nN·m·s/rad"', "damping.0.viscous", "negative damping would drive the body"),
    ("q_factor = 250", 'coulomb = "-1 nN·m"', "damping.0.coulomb", "negative damping would drive the body"),
    ("q_factor = 250", 'coulomb = "1 nN"', "damping.0.coulomb", "here a torque is needed"),
    ("q_factor = 250", "", "damping.0", "missing: q_factor = 250"),
    (
        'body = "balance"\nq_factor',
        'body = "wheel"\nq_factor',
        "damping.0.q_factor",
        "neither a spring nor gravity pulls wheel back",
    ),
    (
        '["wheel.TEETH", "lever"]',
        '["whel.TEETH", "lever"]',
        "contacts.0.between.0",
        'there is no body "whel". Did you mean "wheel"?',
    ),
    ('["wheel.TEETH", "lever"]', '["wheel.TEET", "lever"]', "contacts.0.between.0", 'no such layer. Did you mean "TEETH"?'),
    ('["wheel.TEETH", "lever"]', '["wheel.BORE", "lever"]', "contacts.0.between.0", 'add "BORE" there'),
    ('["wheel.TEETH", "lever"]', '["wheel.TEETH"]', "contacts.0.between", "two sides are needed"),
    ('["wheel.TEETH", "lever"]', '["lever.polygon", "lever"]', "contacts.0.between", "lever cannot touch itself"),
    ('["lever", "balance"]', '["lever", "wheel"]', "contacts.1.between", "contacts.0 declares this pair already"),
    ("friction = 0.12", "friction = -0.12", "contacts.0.friction", "a negative friction coefficient"),
    ("friction = 0.12", 'friction = "0.1 mm"', "contacts.0.friction", "is a length; here a plain number is needed"),
    ("restitution = 0.2", "restitution = 1.2", "contacts.0.restitution", "must lie between 0 (no rebound) and 1"),
    ("restitution = 0.2", "restitution = -0.2", "contacts.0.restitution", "must lie between"),
    ("restitution = 0.2", "tangential_restitution = 0.2", "contacts.0.tangential_restitution", "gives no tangential impulse"),
    ("restitution = 0.2", "tangential_restitution = 2", "contacts.0.tangential_restitution", "must lie between"),
    ('duration = "180 s"', "duration = 180", "run.duration", 'Write "180 s"'),
    ('duration = "180 s"', 'duration = "-1 s"', "run.duration", "must be above zero"),
    ('["179 s", "180 s"]', '["180 s", "179 s"]', "run.record", "from an earlier to a later time"),
    ('["179 s", "180 s"]', '[["1 s", "2 s"], ["4 s", "3 s"]]', "run.record.1", "from an earlier to a later time"),
    ("tolerance = 1e-8", "tolerance = 0", "run.tolerance", "must lie between 1e-13 and 0.01"),
    ('lift_angle = "52°"', 'lift_angle = "400°"', "timegrapher.lift_angle", "below a full turn"),
    ('value = "275°", ', "", "expect.amplitude", "missing: value. Write e.g."),
    ('value = "275°"', 'value = "275 s"', "expect.amplitude.value", "is a time; here an angle is needed"),
    ('tolerance = "0.02 rad"', 'tolerance = "0°"', "expect.amplitude.tolerance", "must be above zero"),
    ("value = 500", 'value = "500 m"', "expect.impacts.tolerance", "a bare number needs a unit"),
]


@pytest.mark.parametrize(("good_part", "bad_part", "expected"), [(a, b, (key, text)) for a, b, key, text in ONE_FAULT if key])
def test_one_mistake_gives_one_clear_fault(desk, good, good_part, bad_part, expected):
    key, message = expected
    assert good_part in good
    faults = faults_of(desk, good.replace(good_part, bad_part, 1))
    assert [fault.key for fault in faults] == [key]
    assert message in str(faults[0])
    assert str(faults[0]).startswith(f"{desk.folder}/scene.toml:")


def test_text_of_a_fault(desk, good):
    (fault,) = faults_of(desk, good.replace('"28800 vph"', "28800"))
    line = 1 + good.split("\n").index('frequency = "28800 vph"')
    assert str(fault) == (
        f"{desk.folder}/scene.toml:{line}  springs.0.frequency = 28800\n"
        '  a bare number needs a unit here: 28800 Hz and 28800 vph differ by a factor of 7200. Write "28800 vph".'
    )


def test_all_faults_at_once_in_the_order_of_the_file(desk, good):
    text = good
    for case in ONE_FAULT[1::5]:
        if case[0] in text and case[2] and not case[2].startswith(("bodies.lever", "contacts.0.between")):
            text = text.replace(case[0], case[1], 1)
    faults = faults_of(desk, text)
    assert len(faults) >= 9
    lines = [int(fault.place.rpartition(":")[2]) for fault in faults]
    assert lines == sorted(lines)


def test_a_wrong_pivot_hides_no_wrong_layer_of_a_contact(tmp_path):
    for name, content in ws.designs.graham().files().items():
        (tmp_path / name).write_bytes(content)
    mapping = read_mapping(tmp_path / "scene.toml")
    body, layer = mapping["contacts"][0]["between"][0].split(".")
    mapping["bodies"][body]["pivot"] = "NOWHERE"
    mapping["contacts"][0]["between"][0] = f"{body}.DENTS"
    with pytest.raises(SceneError) as caught:
        from_mapping(mapping, tmp_path / "scene.toml")
    assert [fault.key for fault in caught.value.faults] == [f"bodies.{body}.pivot", "contacts.0.between.0"]
    assert layer in caught.value.faults[1].message


def test_unknown_key_hides_nothing_else(desk, good):
    keys = [fault.key for fault in faults_of(desk, good.replace('drawing = "wheel.dxf"', 'drawng = "wheel.dxf"'))]
    assert "bodies.wheel.drawng" in keys
    assert "contacts.0.between.0" not in keys or len(keys) > 1


def test_spring_on_an_unknown_body(desk, good):
    keys = [fault.key for fault in faults_of(desk, good.replace('body = "balance"\nfreq', 'body = "balnce"\nfreq'))]
    assert keys == ["springs.0.body"], "that the balance has no spring for its quality factor follows from it"


def test_a_misspelt_inertia_is_one_fault(desk, good):
    text = good.replace('velocity = "360 °/s"\ninertia', 'velocity = "360 °/s"\ninertai')
    assert [fault.key for fault in faults_of(desk, text)] == ["bodies.balance.inertai"], "the spring is there all the same"


def test_contact_of_a_body_without_outline(desk, good):
    faults = faults_of(desk, good.replace(POLYGON, ""))
    assert [fault.key for fault in faults] == ["contacts.0.between.1", "contacts.1.between.0", "contacts.2.between.0"]
    assert "lever has no outline that could touch" in faults[0].message


def test_table_without_over(desk, good):
    text = good.replace('value = "-1.0 µN·m"', 'table = [["0°", "0 N·m"], ["1°", "1 N·m"]]')
    (fault,) = faults_of(desk, text)
    assert 'over = "angle" or over = "time"' in fault.message


def put_wheel(desk, **more):
    desk.put(drawing("wheel.dxf", [square(0.01, (0.003, 0.004), "TEETH")], points=(("PIVOT", 0.003, 0.004),), **more))


def test_errors_of_a_drawing_are_quoted(desk, good):
    gap = Finding(
        "open", "error", "the outline is open: 23 µm between A and B", 'Join them, or set snap = "24 µm".', "TEETH", 1, 2
    )
    put_wheel(desk, layers=("TEETH",), findings=(gap,))
    (fault,) = faults_of(desk, good)
    assert str(fault) == (
        f"{desk.folder}/scene.toml:5  bodies.wheel.drawing -> wheel.dxf, layer TEETH\n"
        '  the outline is open: 23 µm between A and B. Join them, or set snap = "24 µm" under [bodies.wheel].'
    )


def test_layers_left_out_may_be_broken(desk, good):
    gap = Finding("open", "error", "the outline is open", "", "NOTES", 1, 2)
    put_wheel(desk, layers=("TEETH", "NOTES"), findings=(gap,))
    assert load(desk.scene(good)).findings == ()
    (fault,) = faults_of(desk, good.replace('layers = ["TEETH"]\n', ""))
    assert "layer NOTES" in str(fault)


def test_a_drawing_without_units_is_refused_whatever_the_layers(desk, good):
    units = Finding("no-units", "error", "the drawing does not say its units", 'Set units = "mm"')
    put_wheel(desk, findings=(units,))
    (fault,) = faults_of(desk, good)
    assert "does not say its units" in fault.message


def test_units_the_reader_does_not_know(desk, good, monkeypatch):
    from watchsim.scene import outlines as body_outlines

    def broken(*_):
        raise ValueError('"furlong" is not a unit known here')

    monkeypatch.setattr(body_outlines, "cached_drawing", broken)
    (fault,) = faults_of(desk, good.replace('pivot = "PIVOT"', 'pivot = "PIVOT"\nunits = "furlong"'))
    assert (fault.key, fault.message) == ("bodies.wheel.units", '"furlong" is not a unit known here')


def test_a_drawing_without_outlines(desk, good):
    chain = Loop((Line(0, 0, 1, 0),), "0", closed=False)
    desk.put(drawing("wheel.dxf", [], open_chains=(chain,), layers=("0",)))
    (fault,) = faults_of(desk, good.replace('layers = ["TEETH"]\npivot = "PIVOT"\n', "").replace("wheel.TEETH", "wheel"))
    assert fault.message.startswith("it holds no closed outline. Its lines are open: say where their material is, material =")


def test_several_marks_on_the_pivot_layer(desk, good):
    desk.put(drawing("wheel.dxf", [square(0.01, layer="TEETH")], points=(("PIVOT", 0.001, 0.0), ("PIVOT", 0.002, 0.0))))
    (fault,) = faults_of(desk, good)
    assert "2 points or circles are on this layer, at (1.000, 0.000), (2.000, 0.000) mm: leave one" in fault.message


def test_free_body_with_two_centres(desk, good):
    text = good.replace('pivot = "PIVOT"', 'pivot = "PIVOT"\nmotion = "free"').replace(WHEEL_INERTIA, SOLID)
    text = text.replace('[[torques]]\nbody = "wheel"\nvalue = "-1.0 µN·m"\n', "")
    text = text.replace('drawing = "wheel.dxf"\nlayers = ["TEETH"]\npivot', 'layers = ["TEETH"]\ndrawing = "wheel.dxf"\npivot')
    (fault,) = faults_of(desk, text)
    assert "leave out pivot or solids" in fault.message


def test_files_that_are_no_scene(desk, tmp_path):
    with pytest.raises(SceneError, match="there is no such scene file"):
        load(tmp_path / "none.toml")
    with pytest.raises(SceneError, match="this folder holds no scene"):
        load(tmp_path)
    latin = tmp_path / "latin.toml"
    latin.write_bytes('title = "Unruh µ"'.encode("latin-1"))
    with pytest.raises(SceneError, match="not UTF-8: byte 15 is 0xb5"):
        load(latin)


@pytest.mark.parametrize("text", ["x = ", "[a\n", 'a = "1"\na = "2"', "frequency = 4 Hz"])
def test_broken_toml_names_the_line(desk, text):
    (fault,) = faults_of(desk, "# a comment\n" + text)
    assert "not valid TOML" in fault.message
    assert fault.place.endswith(f"scene.toml:{1 + len(text.splitlines())}")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "bodies = 3",
        "[bodies]\nwheel = 3",
        '[[bodies]]\nname = "a"',
        '[bodies.""]\n',
        '[bodies."a.b"]\ninertia = "1 kg·m²"',
        "scene = 1\n[bodies.a]\ncircle = {}",
        'expect = 1\nrun = "x"\ntimegrapher = []\nlock = 4\n[bodies.a]\npolygon = "x"\nsolids = 3\nlayers = [1]',
        "[springs]\n[torques]\nx = 1\n[bodies.a]\nsolids = [1]",
        "springs = [1, 2]\ncontacts = 5\ndamping = [[]]\n[bodies.a]\nposition = 1979-05-27",
    ],
)
def test_wrong_shapes_never_crash(desk, text):
    assert faults_of(desk, text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[bodies]\ndrawing = 'x.dxf'\nposition = ['0 mm', '0 mm']\n",
            "a body is expected here: a table with its name, such as",
        ),
        ("[bodies.a]\ncircle = '1 mm'\ninertia = '1 mg·cm²'\n[[contacts]]\n", "two sides are needed"),
        (
            "[bodies.a]\ncircle = '1 mm'\ninertia = '1 mg·cm²'\n[[springs]]\nbody = ''\nfrequency = '4 Hz'\n",
            "there is no such body",
        ),
        ("[bodies.a]\ncircle = '1 mm'\ninertia = '1 mg·cm²'\n[[damping]]\n", "missing"),
        ("x = " + "[" * 400 + "]" * 400, "nested more than 20 deep"),
        ("x = " + "[" * 5000 + "]" * 5000, "nested more than 20 deep"),
        ("x = " + "9" * 5000, "not valid TOML"),
        ("[bodies.a]\ncircle = '5e101 mm'\n", "too large to compute with"),
        ("[bodies.a]\ncircle = '1 mm'\nmotion = 'free'\nmass = '1e-320 g'\n", "too small to compute with"),
        ("[bodies.a]\ncircle = '1 mm'\ninertia = '1 mg·cm²'\n[run]\nrecord = 'every 99999999999999999999'\n", "every 10"),
        (f"[bodies.a]\ncircle = '0.{'1' * 5000} mm'\n", "more digits than any precision"),
        ("[bodies.a]\ncircle = '1 mm'\ninertia = '1 mg·cm²'\n[run]\ntolerance = 1e-14\n", "between 1e-13 and 0.01"),
    ],
)
def test_damaged_scenes_are_refused_in_words(text, words, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match=words):
        load(path)


# what stands in the good scene | what replaces it (; for a new line) | key and value | message
SAID = """
layers = ["TEETH"] | layers = [] | bodies.wheel.layers = [] | \
nothing of the drawing can touch, though a contact names this body. \
Name the layers that touch, such as ["TEETH"], or leave layers out: then all with closed outlines can.
"wheel.dxf" | "." | bodies.wheel.drawing = "." | this is a folder; the name of a drawing is needed here: wheel.dxf.
"wheel.dxf" | "" | bodies.wheel.drawing = "" | the name of a drawing is needed here: wheel.dxf.

"fixed" | "fix" | bodies.banking.motion = "fix" | not one of pivot, slide, free, fixed, driven. Did you mean "fixed"?
"fixed" | "rigid" | bodies.banking.motion = "rigid" | not one of pivot, slide, free, fixed, driven.
"fixed" | 5 | bodies.banking.motion = 5 | not one of pivot, slide, free, fixed, driven: a text in quotes is needed here.
"fixed" | "slidee"; axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.motion = "slidee" | \
not one of pivot, slide, free, fixed, driven. Did you mean "slide"?
"fixed" | "rail"; axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.motion = "rail" | \
not one of pivot, slide, free, fixed, driven.

title = "Small lever" | schema = "1" | scene.schema = "1" | a plain number is needed here, without quotes: schema = 1.
title = "Small lever" | schema = true | scene.schema = true | a plain number is needed here, without quotes: schema = 1.
title = "Small lever" | schema = 2 | scene.schema = 2 | this version of watchsim reads schema 1. \
Install the watchsim that this scene was written for.
title = "Small lever" | tangential_law = "pg96"; nu = 0.5 | scene.tangential_law = "pg96" | \
not one of coulomb, pg1996, shifted. Did you mean "pg1996"?
title = "Small lever" | tangential_law = "newton"; nu = 0.5 | scene.tangential_law = "newton" | \
not one of coulomb, pg1996, shifted.

value = "-1.0 µN·m" | over = "tme"; table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0.over = "tme" | \
not one of angle, time, barrel. Did you mean "time"?
value = "-1.0 µN·m" | over = "seconds"; table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0.over = "seconds" | \
not one of angle, time, barrel.
value = "-1.0 µN·m" | over = "time" | torques.0 | missing: the table to which over belongs.
value = "-1.0 µN·m" | table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0 | a table needs over = "angle" or over = "time".

frequency = "28800 vph" | freqency = "28800 vph" | springs.0.freqency | unknown key. Did you mean "frequency"?
frequency = "28800 vph" | leaf = {} | springs.0.leaf | missing: modulus, length, width, thickness, arm. Write e.g. \
leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm" } with arm = "2 mm", on a pivoted body.
frequency = "28800 vph" | frequency = "4 Hz"; draw = { stud = "1°" } | springs.0.draw | \
missing: inner, outer, turns. Write e.g. draw = { inner = "0.5 mm", outer = "2.8 mm", turns = 13, stud = "90°" }.
[[springs]] | [springs] | springs | write [[springs]] with double brackets: there can be several.
[[springs]] | [[sprngs]] | sprngs | unknown section. Did you mean "springs"?
friction = 0.12 | lift_angle = "50°" | contacts.0.lift_angle | unknown key. It belongs under [timegrapher].
motion = "fixed" | motion = "fixed"; friction = 0.1 | bodies.banking.friction | \
unknown key. It belongs under [[bearings]] or [[contacts]].
[scene] | title = "x"; [scene] | title | unknown section. It belongs under [scene].
[timegrapher] | [timegrapher]; frequency = "7 Hz" | timegrapher.frequency = "7 Hz" | \
the oscillator makes small swings at 4 Hz (28800 vph), more than 10 % off: look at mass, inertia and spring.
[scene] | [scen] | scen | unknown section. Did you mean "scene"?
motion = "fixed" | moton = "fixed" | bodies.banking.moton | unknown key. Did you mean "motion"?
motion = "fixed" | axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.axis | \
belongs to motion = "slide", which is not written; a body turns unless motion says otherwise.
motion = "fixed" | path = [["1 s", "5°"]] | bodies.banking.path | \
belongs to motion = "driven", which is not written; a body turns unless motion says otherwise.
motion = "fixed" | motion = "driven"; swing = {} | bodies.banking.swing | missing: amplitude, frequency. Write e.g. \
swing = { amplitude = "10°", frequency = "2 Hz" }.
motion = "fixed" | motion = "fixed"; on = "" | bodies.banking.on = "" | \
there is no such body. Known here: wheel, lever, balance.

tolerance = 1e-8 | tolerance = "2 s" | run.tolerance = "2 s" | "2 s" is a time; here a plain number is needed, without a unit.
"lever", "banking.circle" | "lever", 5 | contacts.2.between = ["lever", 5] | \
two sides are needed: between = ["wheel.TEETH", "lever.STONES"].
[run] | [[gears]]; between = ["wheel", "lever"]; ratio = 2; restitution = 0.1; efficiency = 0.9; [run] | gears.0.restitution | \
restitution and efficiency need play: give backlash = "0.5°", how far the second body can go while the first is held.
[run] | [[gears]]; between = ["wheel", "lever"]; ratio = 2; backlash = "1°"; efficiency = "1 s"; [run] | \
gears.0.efficiency = "1 s" | "1 s" is a time; here a plain number is needed, without a unit.
[run] | [[gears]]; between = ["wheel", 3]; ratio = 2; [run] | gears.0.between = ["wheel", 3] | \
two bodies are needed: between = ["wheel", "pinion"].
[run] | [[line_springs]]; between = []; points = [["0 mm", "0 mm"], ["1 mm", "0 mm"]]; stiffness = "1 N/m"; [run] | \
line_springs.0.between = [] | \
one or two bodies are needed: between = ["lever", "wheel"], or ["lever"] for a spring from the movement.
{ value = 500, tolerance = 3 } | {} | expect.impacts | missing: value, tolerance. Write e.g. { value = 500, tolerance = 3 }.

duration = "180 s" | duration = 180 s | duration = 180 s | \
not valid TOML: Expected newline or end of document after a statement. \
Text and quantities need quotes; plain numbers (0.15), true, false and lists do not.
duration = "180 s" | duration = "180 s | duration = "180 s | not valid TOML: Illegal character '\\n'. \
A quotation mark is missing at the end of the line.
[bodies.lever] | [bodies.wheel] | [bodies.wheel] | not valid TOML: Cannot declare ('bodies', 'wheel') twice. \
This table is there already: give it another name, or make one of both.
friction = 0.12 | friction = 0.1; friction = 0.2 | friction = 0.2 | not valid TOML: Cannot overwrite a value. \
This key has a value already: leave one of them out.
"""


@pytest.mark.parametrize("row", [row for row in SAID.splitlines() if row])
def test_one_mistake(desk, good, row):
    right, wrong, heading, message = row.split(" | ")
    assert right in good
    path = desk.scene(good.replace(right, wrong.replace("; ", "\n"), 1))
    with pytest.raises(SceneError) as caught:
        load(path)
    place, _, said = str(caught.value).partition("  ")
    assert said == f"{heading}\n  {message}"
    assert place.startswith(f"{path}:")


def only(text: str, desk) -> str:
    with pytest.raises(SceneError) as caught:
        load(desk.scene(text))
    (fault,) = caught.value.faults
    return str(fault).partition("/scene.toml:")[2]


@pytest.mark.parametrize("bodies", ["", "[bodies]\n", "bodies = 5\n", "bodies = []\n"])
def test_without_bodies_none_of_them_is_missed(desk, good, bodies):
    start, end = good.index("[bodies.wheel]"), good.index("[[springs]]")
    with pytest.raises(SceneError) as caught:
        load(desk.scene(bodies + good[:start] + good[end:]))
    assert [fault.key for fault in caught.value.faults] == ["bodies"]


def test_forces_on_a_body_that_there_is_not_may_be_of_either_kind(desk, good):
    spring = '[[springs]]\nbody = "rack"\nstiffness = "1 N/m"\npreload = "2 N"\n'
    torque = '[[torques]]\nbody = "rack"\nover = "travel"\ntable = [["0 mm", "0 N"], ["1 mm", "1 N"]]\n'
    for text in (spring, torque, '[[damping]]\nbody = "rack"\nviscous = "1 N·s/m"\n'):
        assert "there is no such body" in only(good + text, desk)
    other = good + spring.replace("1 N/m", "3 s")
    with pytest.raises(SceneError, match="is a time; here a rotary stiffness or stiffness is needed"):
        load(desk.scene(other))


def test_a_misspelt_table_keeps_its_lines_and_its_faults(desk, good):
    """Both mistakes are told, with the keys and lines that stand in the file."""
    with pytest.raises(SceneError) as caught:
        load(desk.scene(good.replace("[scene]\ntitle", "[scen]\ntitel").replace('"Small lever"', "5")))
    faults = [(fault.key, fault.place.rpartition(":")[2]) for fault in caught.value.faults]
    assert faults == [("scen", "1"), ("scen.titel", "2"), ("scen.titel", "2")]


def test_the_body_of_a_spring_may_be_anything_beside_gears(desk, good):
    gears = '[[gears]]\nbetween = ["wheel", "lever"]\nratio = 2\n'
    assert "a text in quotes is needed" in only(good.replace('body = "balance"\nfreq', "body = []\nfreq") + gears, desk)


def calls_of_refusing(mapping):
    """How many functions are called until the mapping is refused, and with which error."""
    count = 0

    def note(_frame, event, _arg):
        nonlocal count
        count += event == "call"

    sys.setprofile(note)
    try:
        from_mapping(mapping, None)
    except SceneError as error:
        return count, error
    finally:
        sys.setprofile(None)
    raise AssertionError("nothing was refused")


MANY = [
    lambda n: {"bodies": {"a": {"inertia": "1 g·cm²", **{f"k{i}": i for i in range(n)}}}},
    lambda n: {"bodies": {"a": {"inertia": "1 g·cm²"}}, **{f"k{i}": {} for i in range(n)}},
    lambda n: {"bodies": {"a": {"inertia": "1 g·cm²"}}, "springs": [{"body": "a", "stifness": "1 N·m/rad"}] * n},
]


@pytest.mark.parametrize("made", MANY)
def test_many_slips_take_work_in_proportion(made):
    (few, _), (many, error) = calls_of_refusing(made(400)), calls_of_refusing(made(1600))
    assert many < 5 * few
    assert ("1499 more after it" in str(error)) or (len(error.faults) == 1600 and "and 1100 more faults" in str(error))


def test_what_is_found_several_times_is_said_once(tmp_path, capsys):
    """Three pieces of no length in one path."""
    path = '<path id="plate" d="M0,0 L10,0 L10,0 L10,10 L10,10 L0,10 L0,10 Z"/>'
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20">'
    (tmp_path / "plate.svg").write_text(f"{head}{path}</svg>", encoding="utf-8")
    body = '[bodies.plate]\ndrawing = "plate.svg"\npivot = ["5 mm", "5 mm"]\ninertia = "1 g·mm²"\n'
    (tmp_path / "scene.toml").write_text(body, encoding="utf-8")
    main(["check", str(tmp_path / "scene.toml")])
    (line,) = [line for line in capsys.readouterr().out.splitlines() if "no length" in line]
    assert line.endswith("(3 times)")
