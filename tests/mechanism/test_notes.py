"""Does a scene say aloud what it leaves unsaid, in run as in check, and no more than once?"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from watchsim.cli import main
from watchsim.commands.common.console import BAD_INPUT, FINE
from watchsim.mechanism.notes import notes
from watchsim.scene.file.load import load

HEAD = '[scene]\nschema = 1\ngravity = ["0 m/s²", "-9.81 m/s²"]\n'
FLAT = "[scene]\nschema = 1\n"
DISC = '[bodies.disc]\ncircle = "5 mm"\ninertia = "1 g·cm²"\n'
SPRING = '[[springs]]\nbody = "disc"\nfrequency = "4 Hz"\n'
END = '[run]\nduration = "0.01 s"\n'
CASES = {
    "gravity without a mass": (HEAD + DISC + END, "poised", "disc has no mass, so gravity does not turn it"),
    "mass beside inertia": (
        HEAD + DISC.replace("inertia", 'angle = "9°"\npivot = ["0 mm", "2 mm"]\nmass = "1 g"\ninertia') + END,
        "centre-of-mass",
        "taken from its outline as of a uniform plate, 2 mm beside the pivot",
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
