"""Does the printed timeline hold the numbers of its beats, each in its column?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.analysis.timeline import timeline_table as module
from watchsim.analysis.timeline.shown_beats import Beat
from watchsim.analysis.timeline.timeline_table import timeline_text

DEGREE = math.pi / 180.0
Triple = tuple[float, float, float]


def stage(name: str, on: str, times: tuple[float, float], places: Triple, rates: Triple, **energy: Any) -> Any:
    """Places and rates in degrees, at the end of the phase those of `ends`; energies in nJ."""
    ends, impulse, impacts = energy.pop("ends"), energy.pop("impulse"), energy.pop("impacts", {})
    phase = SimpleNamespace(start=times[0], end=times[1], on=on, angles=tuple(DEGREE * one for one in places))
    return SimpleNamespace(
        name=name,
        beat=7,
        pallet="exit",
        phase=phase,
        impulse=1e-9 * impulse,
        start_rates=tuple(DEGREE * one for one in rates),
        end_angles=tuple(DEGREE * one for one in ends[0]),
        end_rates=tuple(DEGREE * one for one in ends[1]),
        energy=SimpleNamespace(
            **{key: 1e-9 * value for key, value in energy.items()}, impacts={k: 1e-9 * v for k, v in impacts.items()}
        ),
    )


ENDS = (10.0, 20.0, 30.0), (1000.0, 2000.0, 3000.0)
UNLOCK = stage(
    *("unlock", "", (1.25, 1.2525), (-3.5, 4.25, -26.0), (0.0, -750.0, 6250.0)), ends=ENDS, impulse=-2.5, friction=2.0,
    supplied=-8.0, to_balance=-12.5, stored=1.5, damping=0.25, impacts={"lever-balance": 3.0},
)  # fmt: skip
IMPULSE = stage(
    *("impulse", "stone", (1.2525, 1.26), (-3.0, 2.5, -15.0), (-125.0, -1500.0, 6500.0)),
    ends=((-9.5, -4.75, 21.0), (-2000.0, 333.0, 6750.0)), impulse=11.25, friction=5.0,
    supplied=48.0, to_balance=33.75, stored=22.0, damping=0.75, impacts={"lever-balance": 1.0, "wheel-lever": 4.0},
)  # fmt: skip
BEAT: Any = Beat((UNLOCK, IMPULSE), ({"wheel-lever": 0.5e-9}, {"lever-balance": 1.5e-9, "wheel-lever": 2.5e-9}))
NAMED = SimpleNamespace(wheel="wheel", lever="lever", oscillator="balance")


def printed(monkeypatch: pytest.MonkeyPatch, beats: list[Any], **parts: str) -> list[str]:
    monkeypatch.setattr(module, "with_anchor", lambda scene: SimpleNamespace(**(vars(NAMED) | parts)))
    run: Any = SimpleNamespace(scene=None)
    return timeline_text(run, beats).split("\n")


WORDS = "angles in degrees and angular velocities in 1000 °/s, at the start of each phase; times in ms from the "
MOTION = """\
Timeline, t = 1.250000 s to 1.260000 s
WORDS
                        start   length                wheel               lever             balance
                           ms       ms           °  1000°/s          °  1000°/s          °  1000°/s
beat 7, exit stone, t = 1.250000 s
  unlock                0.000    2.500      -3.500    0.000      4.250   -0.750    -26.000    6.250
  impulse on stone      2.500    7.500      -3.000   -0.125      2.500   -1.500    -15.000    6.500
  end                  10.000               -9.500   -2.000     -4.750    0.333     21.000    6.750
"""
ENERGY = """\
energy in nJ; f: friction, i: impacts; to balance: work of all contacts on the oscillator; impulse on it in nN·m·s
                      impulse   supplied  to balance     stored    damping  f lever-balance  f wheel-lever  i lever-balance  i wheel-lever
beat 7, exit stone, t = 1.250000 s
  unlock               -2.500    -8.0000    -12.5000     1.5000     0.2500                -         0.5000           3.0000              -
  impulse on stone     11.250    48.0000     33.7500    22.0000     0.7500           1.5000         2.5000           1.0000         4.0000
  together              8.750    40.0000     21.2500    23.5000     1.0000           1.5000         3.0000           4.0000         4.0000
  of what is supplied           100.00 %     53.12 %    58.75 %     2.50 %           3.75 %         7.50 %          10.00 %        10.00 %
  the account closes to 2.5e-09 J, 6.2e-02 of what is supplied
"""  # noqa: E501


def test_every_number_in_its_column(monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction by forces is 4.5 nJ, what the books lack 7 nJ: they close to 2.5 nJ of 40 nJ."""
    assert printed(monkeypatch, [BEAT]) == [
        *MOTION.replace("WORDS", f"{WORDS}beginning of the unlocking").splitlines(),
        "",
        *ENERGY.splitlines(),
    ]


def test_an_anchor_has_one_column(monkeypatch: pytest.MonkeyPatch) -> None:
    """Names are cut to thirteen letters."""
    lines = printed(monkeypatch, [BEAT], lever="pendulum with anchor", oscillator="pendulum with anchor")
    assert lines[2].split() == ["start", "length", "wheel", "pendulum", "with"] and lines[3].split().count("°") == 2
    assert lines[5] == MOTION.splitlines()[5][:-20]


@pytest.mark.parametrize(("supplied", "shared"), [(1e-3, True), (0.0, False), (-1e-3, False)])
def test_shares_only_of_what_is_supplied(monkeypatch: pytest.MonkeyPatch, supplied: float, shared: bool) -> None:
    """Times count from each beat's own start; one that begins on no stone names none."""
    first: Any = SimpleNamespace(**vars(IMPULSE) | {"pallet": "", "energy": SimpleNamespace(**vars(IMPULSE.energy))})
    first.energy.supplied = 1e-9 * supplied
    lines = printed(monkeypatch, [BEAT, Beat((first,), ({},))])
    assert lines[0] == "Timeline, t = 1.250000 s to 1.260000 s" and lines[8] == "beat 7, t = 1.252500 s"
    assert lines[9].split()[3:5] == ["0.000", "7.500"] and lines[10].split()[1] == "7.500"
    assert lines[-3 if shared else -1].startswith("  together")
    assert lines[-1].startswith("  the account closes") is shared
