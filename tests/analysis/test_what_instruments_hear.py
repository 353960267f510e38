"""What do timing machines make of our sound: one that finds the first noise of a beat, and one that waits for a loud one?"""

import re
from pathlib import Path

import numpy as np
import pytest
from naive.level_trigger import beat_error_ms
from render.fake_runs import watch_run

import watchsim as ws
from watchsim.analysis.sound import another_beat_error
from watchsim.analysis.timegrapher import tape
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.trajectory import Trajectory


def sounding(blows: list[tuple[float, float]], path: Path) -> bytes:
    """The WAV of a run with impacts at those times (s) that lose those energies (J)."""
    run = watch_run(duration=1.0)
    rows = [(t, EventKind.IMPACT, 0, -1, 2e-9, 0.0, energy, 0.0) for t, energy in blows]
    return ws.sound(Trajectory(**{**run.__dict__, "events": np.array(rows, dtype=EVENT_DTYPE)}), path).read_bytes()


def test_a_blow_in_many_impacts_is_as_loud_as_one_of_their_energy(tmp_path: Path) -> None:
    quiet, loud = (0.2, 1e-12), 4e-12
    parts = [(0.5 + k * 1e-6, loud / 8.0) for k in range(8)]
    assert sounding([quiet, *parts], tmp_path / "parts.wav") == sounding([quiet, (0.5, loud)], tmp_path / "one.wav")
    apart = [(0.5 + k * 1e-4, loud / 8.0) for k in range(8)]
    assert sounding([quiet, *apart], tmp_path / "apart.wav") != sounding([quiet, (0.5, loud)], tmp_path / "whole.wav")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("profile", "duration", "beat", "late"),
    [
        ("coaxial", 12.0, 1.0 / 7.0, (0.5, 0.8)),
        ("tourbillon", 10.0, 0.125, (0.3, 0.7)),
        ("swiss_lever", 12.0, 0.125, (0.05, 0.2)),
    ],
)
def test_the_first_noise_gives_the_true_beat_error_and_a_loud_one_another(
    profile: str, duration: float, beat: float, late: tuple[float, float], tmp_path: Path
) -> None:
    """docs/guide/coaxial.md says so, with figures: louder noises come at different times after the first in tick and tock."""
    run = ws.simulate(ws.load(ws.profiles_dir() / profile), duration=duration, record="all")
    file = ws.sound(run, tmp_path / "tick.wav")
    true = float(np.nanmean(tape(run).beat_error_ms))
    heard = ws.listen(file)
    assert heard.beat_error_ms == pytest.approx(true, abs=0.05)
    assert heard.amplitude_deg is not None
    assert beat_error_ms(file, 0.05, beat) == pytest.approx(true, abs=0.05)
    loud = beat_error_ms(file, 0.3, beat)
    assert late[0] < loud < late[1]
    note = another_beat_error(run, (duration - 8.0 * beat, duration))  # beside the sound of a page
    assert (note == "") == (profile == "swiss_lever")
    if note:
        shown = [float(text) for text in re.findall(r"(\d+\.\d+) ms", note)]
        assert shown[2:] == [pytest.approx(loud, abs=0.1), pytest.approx(true, abs=0.06)]
