"""Does the sound that is drawn agree with the WAV file, and are its noises named by what met?"""

import wave
from pathlib import Path

import numpy as np
import pytest
from render.fake_runs import watch_run

import watchsim as ws
from watchsim.mechanism.compile import compile_scene
from watchsim.simulation.state import EventKind

STEP = 2e-3  # s


def test_the_curve_is_the_sound_and_names_are_those_of_the_impacts(tmp_path: Path) -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "swiss_lever"), duration=0.6, record="all")
    window = (0.3, 0.6)
    axes = ws.plot_sound(run, window).axes[0]
    x, y = axes.lines[0].get_data()
    with wave.open(str(ws.sound(run, tmp_path / "tick.wav"))) as file:
        rate, samples = file.getframerate(), np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    heard = samples[round(0.3 * rate) : round(0.58 * rate)]
    # Envelopes of two milliseconds: the plot keeps what a picture needs, the file every sample.
    t = np.asarray(x) / 1e3  # a window that ends before 1 s counts ms from zero
    edges = np.arange(0.3, 0.58, STEP)
    drawn = np.array([np.abs(y[(t >= a) & (t < a + STEP)]).max(initial=0.0) for a in edges])
    file_envelope = np.array([np.abs(heard[round((a - 0.3) * rate) :][: round(STEP * rate)]).max() for a in edges])
    assert np.corrcoef(drawn, file_envelope)[0, 1] > 0.99
    impacts = run.events[run.events["kind"] == EventKind.IMPACT]
    roles = {"FORK": "fork", "PIN": "roller jewel", "ARMS": "lever", "PINS": "banking", "TEETH": "wheel"}
    compiled, known = compile_scene(run.scene), set()
    for contact in {int(number) for number in impacts["contact"]}:
        sides = (int(compiled.model.contacts[contact][side]) for side in ("a", "b"))
        where = {compiled.layers[side]: float(compiled.model.primitives[side].px) for side in sides}
        # The wheel turns clockwise below the lever: its teeth come from the left.
        stone = "entry stone" if where.get("STONES", 0.0) < 0.0 else "exit stone"
        known.add(" / ".join(sorted(roles.get(layer, stone) for layer in where)))
    named = {" / ".join(sorted(text.get_text().split(" / "))) for text in axes.texts}
    assert len(named) >= 3 and named <= known


def test_silence_is_refused() -> None:
    with pytest.raises(ValueError, match="nothing sounds there"):
        ws.plot_sound(watch_run(), (0.01, 0.011))
