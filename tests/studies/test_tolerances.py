"""Is a study of tolerances the same study wherever and in whatever order its samples are computed?"""

import json
import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.scene.load import changed
from watchsim.studies.point import answer
from watchsim.studies.study_report import tolerance_text
from watchsim.studies.tolerance import finished, sample_scene
from watchsim.studies.tolerance_plan import plan_of

TABLE = """
[tolerances]
"torques.0.value" = { limits = "±0.5 µN·m" }
"springs.0.stiffness" = { limits = "±0.01 µN·m/rad", distribution = "normal", cpk = 1.0 }
"contacts.0.friction" = { limits = "±0.03", group = "oil" }
"contacts.1.friction" = { limits = "±0.03", group = "oil" }
"bodies.balance.inertia" = { limits = "±0.05 mg·cm²" }
"""
EXPECTED = """
[expect]
"amplitude" = { min = "%s" }
"""


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A bench lever whose tolerances change nothing of its outlines, so that a sample takes a few hundredths of a second."""
    folder = tmp_path_factory.mktemp("tolerances")
    source = ws.profiles_dir() / "bench_lever"
    for path in source.iterdir():
        if path.suffix == ".dxf":
            (folder / path.name).write_bytes(path.read_bytes())
    text = (source / "scene.toml").read_text(encoding="utf-8").partition("[expect]")[0]
    middle = ws.steady(source).amplitude_deg
    (folder / "scene.toml").write_text(text + TABLE + EXPECTED % f"{middle - 2.0:.4f}°", encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def whole(desk):
    return ws.tolerance(desk, 48, folder=desk / "whole")


def results(study):
    return {number: {key: value for key, value in row.items() if key != "seconds"} for number, row in study.rows.items()}


def test_the_study_says_what_json_promises(whole):
    numbers = whole.numbers()
    assert numbers["samples"] == 48
    assert 0 < numbers["good"] < 48
    assert numbers["yield"] == numbers["good"] / 48
    assert numbers["yield_low"] <= numbers["yield"] <= numbers["yield_high"]
    assert sum(numbers["failures"].values()) == 48 - numbers["good"]
    for column, one in whole.outputs.items():
        assert all(value == 0.0 or abs(value) > 1e-9 for value in (one.mean, one.sigma))  # no rounding is judged
        if one.nominal is not None:  # a beat error is a magnitude: its worst case was that of the signed one
            assert one.linear_low <= one.nominal <= one.linear_high
            assert column != "beat_error_ms" or one.linear_low >= 0.0
    spread = numbers["outputs"]["amplitude_deg"]
    assert {"mean", "sigma", "quantiles", "cp", "cpk"} <= set(spread)
    assert {one["key"] for one in numbers["contributions"]["amplitude_deg"]} == {
        *("torques.0.value", "springs.0.stiffness", "oil", "bodies.balance.inertia")
    }
    assert numbers["worst"][0]["why"].startswith("amplitude too low")
    assert "torque 0" in whole.message
    json.dumps(numbers, allow_nan=False)
    assert "amplitude (°)" in whole._repr_html_() and "<img" in whole._repr_html_()


def test_rank_correlations_have_their_reason_and_their_sign(desk, whole):
    """A friction for each contact, these correlated: no shares of variance, and bars on both sides of 0."""
    assert "rank correlations" not in tolerance_text(whole)
    text = (desk / "scene.toml").read_text(encoding="utf-8")
    one, bound = '"±0.03", group = "oil" }', '"±0.03", correlated = { "torques.0.value" = %g } }'
    (desk / "bound.toml").write_text(text.replace(one, bound % 0.5, 1).replace(one, bound % 0.1, 1), encoding="utf-8")
    study = ws.tolerance(desk / "bound.toml", 32)
    assert "  rank correlations, not shares: inputs are correlated\n" in tolerance_text(study)
    ranks = {contribution.rank for contribution in study.contributions["amplitude_deg"]}
    assert min(ranks) < 0.0 < max(ranks)
    bars = {patch.get_width() for axes in ws.plot_tolerance(study).axes for patch in axes.patches if patch.get_height() == 0.7}
    assert ranks <= bars


def test_the_linear_prediction_is_that_of_the_sensitivities(desk, whole):
    """Its variance is the sum of squares of the derivatives by the standard deviations; in this range to 5 %."""
    keys = ["torques.0.value", "springs.0.stiffness", "bodies.balance.inertia", "contacts.0.friction", "contacts.1.friction"]
    found = ws.sensitivity(desk, keys)
    slopes = {one.quantity.key: one.by for one in found.effects}
    spreads = {"torques.0.value": 0.5e-6 / math.sqrt(3.0), "springs.0.stiffness": 0.01e-6 / 3.0}
    spreads["bodies.balance.inertia"] = 0.05e-10 / math.sqrt(3.0)
    for column in ("amplitude_deg", "rate_s_per_d"):
        parts = [slopes[key][column].value * spread for key, spread in spreads.items()]
        oil = sum(slopes[f"contacts.{i}.friction"][column].value for i in (0, 1)) * 0.03 / math.sqrt(3.0)
        assert whole.outputs[column].linear_sigma == pytest.approx(math.sqrt(sum(p * p for p in parts) + oil * oil), rel=0.05)


@pytest.mark.slow
def test_shards_in_any_order_and_a_resumed_study_have_the_same_bits(desk, whole):
    for i in (2, 1, 3):
        ws.tolerance(desk, 48, shard=(i, 3), folder=desk / f"shard{i}")
    merged = ws.merge([desk / f"shard{i}" for i in (3, 1, 2)], desk / "merged")
    assert merged.whole
    assert results(merged) == results(whole)
    ws.tolerance(desk, 16, folder=desk / "resumed")
    path = desk / "resumed" / "rows.jsonl"
    path.write_bytes(path.read_bytes()[:-40])  # as if the power had failed while the last row was written
    again = ws.tolerance(desk, 48, folder=desk / "resumed", resume=True)
    assert results(again) == results(whole)
    assert again.numbers()["contributions"] == whole.numbers()["contributions"]


@pytest.mark.slow
def test_two_processes_have_the_same_bits(desk, whole):
    assert results(ws.tolerance(desk, 48, workers=2)) == results(whole)


def test_a_sample_can_be_replayed(desk, whole, capsys):
    number = whole.worst[0]["sample"]
    cycle = ws.steady(sample_scene(desk / "whole", number))
    assert cycle.amplitude_deg == pytest.approx(whole.rows[number]["amplitude_deg"], abs=1e-6)
    assert finished(desk / "whole").yield_ == whole.yield_
    with pytest.raises(ValueError, match="no sample 48"):
        sample_scene(desk / "whole", 48)
    status = main(
        ["run", str(desk / "whole"), "--sample", str(number), "--duration", "0.2 s", "--no-plots", "-o", str(desk / "run")]
    )
    assert status in (0, 1)
    assert f"sample {number}" in capsys.readouterr().out


@pytest.mark.parametrize("key", ["tolerances.contacts.0.friction.limits", 'tolerances."contacts.0.friction".limits'])
def test_limits_are_set_like_any_other_value(desk, capsys, key):
    assert main(["check", str(desk), "--set", f"{key}=±0.01"]) == 0
    assert [line.split()[:3] for line in capsys.readouterr().out.splitlines() if "contacts.0.friction" in line] == [
        ["contacts.0.friction", "0.15", "±0.01,"]
    ]


def test_a_study_with_limits_set_is_another_one_and_can_be_replayed(desk, capsys):
    wide = ["--set", "tolerances.torques.0.value.limits=±1 µN·m", "--no-plots", "-o", str(desk / "wide")]
    assert main(["tolerance", str(desk), "--samples", "16", *wide]) == 0
    scene = sample_scene(desk / "wide", 3)
    drawn = ws.tolerance(changed(ws.load(desk), {"tolerances.torques.0.value.limits": "±1 µN·m"}), 16)
    assert results(finished(desk / "wide")) == results(drawn)
    assert scene.torques[0].value != ws.load(desk).torques[0].value
    assert main(["tolerance", str(desk), "--samples", "16", "--no-plots", "--resume", "-o", str(desk / "wide")]) == 2
    unknown = ["tolerances.torques.0.nonsense.limits=±1 µN·m", "tolerances.torques.0.value.limit=±1 µN·m"]
    assert main(["check", str(desk), *(word for one in unknown for word in ("--set", one))]) == 2
    said = capsys.readouterr().err
    assert "torques.0.nonsense" in said or "unknown key" in said


@pytest.mark.slow
def test_a_study_stops_once_the_yield_is_known_closely_enough(desk):
    study = ws.tolerance(desk, 4096, until="±45 %")
    assert study.samples == 256
    assert 0.5 * (study.yield_high - study.yield_low) <= 0.45


@pytest.mark.slow
def test_rare_failures_of_a_watch_are_those_of_plain_sampling(desk, whole):
    """The share of watches below a limit in the tail: 512 that are drawn mostly near it against 4096 drawn as they are made."""
    amplitudes = whole.outputs["amplitude_deg"]
    limit = f"{amplitudes.mean - 1.9 * amplitudes.sigma:.4f}°"
    scene = changed(ws.load(desk), {"expect.amplitude.min": limit})
    plain, near = ws.tolerance(scene, 4096, workers=2), ws.tolerance(scene, 512, importance=True, workers=2)
    failing = 1.0 - plain.yield_
    assert 5e-4 < failing < 4e-2
    half = [0.5 * (one.yield_high - one.yield_low) for one in (plain, near)]
    assert half[1] < half[0]
    assert abs(near.yield_ - plain.yield_) < 1.5 * math.hypot(*half)


def test_shards_of_another_study_are_refused(desk, whole):
    ws.tolerance(desk, 16, seed=1, shard=(1, 16), folder=desk / "other")
    with pytest.raises(ValueError, match="seed differ"):
        ws.merge([desk / "whole", desk / "other"])
    with pytest.raises(ValueError, match="another study: seed was 0, now 1"):
        ws.tolerance(desk, 16, seed=1, folder=desk / "whole", resume=True)
    with pytest.raises(ValueError, match="holds no study"):
        ws.merge([desk])


def test_the_command_writes_numbers_table_plot_and_page(desk, whole, capsys):
    folder = desk / "command"
    assert main(["tolerance", str(desk), "--samples", "48", "--workers", "1", "-o", str(folder), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["yield"] == whole.yield_
    lines = (folder / "tolerance.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 49
    values = dict(zip(lines[0].split(","), lines[1].split(","), strict=True))
    assert float(values["contacts.0.friction"]) == float(values["contacts.1.friction"])
    assert float(values["amplitude_deg"]) == whole.rows[0]["amplitude_deg"]
    assert (folder / "tolerance.png").stat().st_size > 10_000
    assert main(["report", str(folder)]) == 0
    page = (folder / "tolerance.html").read_text(encoding="utf-8")
    assert whole.message in page
    capsys.readouterr()
    assert main(["check", str(desk), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["tolerances"]) == 5


FAULTS = [
    ('"torques.0.valu" = { limits = "±1 µN·m" }', "there is no dimension of that name"),
    ('"torques.0.value" = { limits = "+3/+1 µN·m" }', "exclude the nominal value"),
    ('"torques.0.value" = { limits = "±1 mm" }', "is a length"),
    ('"torques.0.value" = { limits = "h6" }', "a fit class is for lengths"),
    ('"torques.0.value" = { limits = "±1 µN·m", cpk = 1.0 }', 'belongs to distribution = "normal"'),
    ('"torques.0.value" = { limits = "±1 µN·m", distribution = "gauss" }', "not one of uniform"),
    ('"torques.0.value" = { limits = "±1 µN·m", each = true }', "one value for each tooth"),
    ('"torques.0.value" = { distribution = "file", file = "none.txt" }', "cannot be read"),
    ('"torques.0.value" = { limit = "±1 µN·m" }', 'Did you mean "limits"?'),
    ('"balance.BODY.offset" = { limits = "±1 µm", correlated = { "none" = 0.5 } }', "there is no other tolerance"),
    *(
        (
            f'"torques.0.value" = {{ limits = "±1 µN·m" }}\n'
            f'"contacts.0.friction" = {{ limits = "±0.1", correlated = {{ "torques.0.value" = {number} }} }}',
            "a coefficient lies between -1 and 1, without its ends",
        )
        for number in ("true", "1", "-1.0", '"0.5"')
    ),
]


def test_another_study_is_refused_before_anything_is_computed(desk, whole, monkeypatch):
    def never(*_, **__):
        raise AssertionError("a limit cycle was looked for")

    monkeypatch.setattr("watchsim.studies.tolerance_plan.steady", never)
    other = changed(ws.load(desk), {"torques.0.value": "-5.1 µN·m"})
    with pytest.raises(ValueError, match="another study"):
        ws.tolerance(other, 48, folder=desk / "whole", resume=True)


def test_what_is_drawn_together_is_for_each_tooth_or_for_none(tmp_path):
    head = '[scene]\ntitle = "watch"\n[design]\nof = "swiss_lever"\n[tolerances]\n'
    line = '"bodies.wheel.teeth.%s" = { limits = "±1 µm", group = "cut"%s }\n'
    each = ", each = true"
    (tmp_path / "scene.toml").write_text(head + line % ("height", each) + line % ("width", each), encoding="utf-8")
    assert [one.count for one in ws.load(tmp_path).tolerances] == [15, 15]
    (tmp_path / "scene.toml").write_text(head + line % ("height", each) + line % ("width", ""), encoding="utf-8")
    with pytest.raises(ws.SceneError, match=r"teeth.width.group\n.*write each = true for all of them"):
        ws.load(tmp_path)


def test_all_faults_are_reported_at_once(desk):
    base = (desk / "scene.toml").read_text(encoding="utf-8").partition("[tolerances]")[0]
    for line, message in FAULTS:
        (desk / "faulty.toml").write_text(f"{base}[tolerances]\n{line}\n", encoding="utf-8")
        with pytest.raises(ws.SceneError, match=message.replace("?", r"\?")):
            ws.load(desk / "faulty.toml")
    with pytest.raises(ws.SceneError, match=r'write "contacts.0.friction.static", "contacts.0.friction.sliding" in its place'):
        ws.load(desk).set("contacts.0.friction", {"static": 0.2, "sliding": 0.1})
    three = [
        '"contacts.0.friction" = { limits = "±0.1", correlated = { "contacts.1.friction" = 0.9, "torques.0.value" = 0.9 } }',
        '"contacts.1.friction" = { limits = "±0.1", correlated = { "torques.0.value" = -0.9 } }',
        '"torques.0.value" = { limits = "+3/+1 µN·m" }',  # its own fault hides none of its correlations
        '"springs.0.rest" = { limits = "±0°" }',
    ]
    (desk / "faulty.toml").write_text("\n".join([f"{base}[tolerances]", *three]), encoding="utf-8")
    with pytest.raises(ws.SceneError) as caught:
        ws.load(desk / "faulty.toml")
    for words in ("not positive definite", "exclude the nominal value", "leave no width"):
        assert [words in str(fault) for fault in caught.value.faults].count(True) == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--until", "±0.5"], ("until", "%")),
        (["--samples", "0", "--until", "2 mm", "--shard", "4/3"], ("samples", "until", "shard")),
        (["--samples", "1000000000"], ("from 16 to 1000000",)),
        (["--seed", "-1", "--workers", "0"], ("--seed -1", "--workers 0")),
    ],
)
def test_options_that_cannot_be_are_refused_together(desk, capsys, options, words):
    assert main(["tolerance", str(desk), *options, "-o", str(desk / "never")]) == 2
    said = capsys.readouterr().err
    assert all(word in said for word in words)
    assert not (desk / "never").exists()


def test_teeth_grown_and_moved_are_where_they_are_expected():
    """Of a ratchet wheel: the offset moves every edge by itself, a pitch error one tooth, and both leave the pivot alone."""
    scene = ws.designs.swiss_lever().scene()
    wheel = scene.body("wheel").loops[1]
    out = changed(scene, {"bodies.wheel.adjust.TEETH.offset": 2e-6}).body("wheel").loops[1]
    for before, after in zip(wheel.edges, out.edges, strict=True):
        (x, y), (tx, ty) = before.point(0.5), before.tangent(0.5)
        ax, ay = after.point(0.5)
        assert (ax - x) * ty - (ay - y) * tx == pytest.approx(2e-6, rel=1e-3)
    pitch = np.zeros(15)
    pitch[0] = 3e-6
    moved = changed(scene, {"bodies.wheel.teeth.pitch": pitch.tolist()}).body("wheel").loops[1]
    ends = [(np.array(a.start), np.array(b.start)) for a, b in zip(wheel.edges, moved.edges, strict=True)]
    tips = [float(np.linalg.norm(b - a)) for a, b in ends if np.linalg.norm(a) > 2.3e-3]
    assert max(tips) == pytest.approx(3e-6, rel=0.02)
    assert sum(tip > 1e-9 for tip in tips) * 15 == pytest.approx(len(tips), abs=15)
    taken = changed(scene, {"bodies.lever.play": 8e-6, "bodies.lever.side": 0.5 * math.pi}).body("lever").position
    assert taken[1] - scene.body("lever").position[1] == pytest.approx(4e-6, rel=1e-9)


@pytest.mark.parametrize(("lock", "number", "works"), [("2.2°", 13, False), ("3°", 3, True)])
def test_a_sample_that_cannot_stand_where_the_drawing_does_is_judged_by_its_motion(lock, number, works, tmp_path):
    """With a lock of 2.2° this one reaches its other bank before the tooth is let off: at the amplitude of the drawing its dart
    would lie within the safety roller, and it was called impossible. With 3° a nudged watch overlaps by 0.7 µm at the start,
    and the whole study was refused.
    """
    assert main(["new", "swiss_lever", "--lock", lock, "-o", str(tmp_path / "new")]) == 0
    plan = plan_of(ws.load(tmp_path / "new"))
    row = answer(plan.question, plan.changes([number])[0])
    assert (row["verdict"], row["amplitude_deg"] is not None) == (("ticks", True) if works else ("stops", False))
