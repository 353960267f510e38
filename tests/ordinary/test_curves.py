"""Does the motion converge with the number of arcs or chords a curve is drawn with?"""

from __future__ import annotations

import pytest
from flat_cams import compared
from reference.flat_cam import Curve, FlatCam, Harmonic, Oval


@pytest.mark.parametrize("curve", [Oval(), Harmonic()])
@pytest.mark.parametrize(("chords", "order"), [(False, 3.0), (True, 1.0)])
@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_arcs_converge_at_third_and_chords_at_first_order(curve: Curve, chords: bool, order: float, restitution: float) -> None:
    runs = [compared(FlatCam(curve), count, chords, restitution) for count in (32, 128)]
    assert all(run.stop == "DURATION" and abs(run.residual) < 1e-6 for run in runs)
    assert runs[0].angle / runs[1].angle == pytest.approx(4.0**order, rel=0.3)
    assert runs[1].events / runs[1].passed < 1.1 * runs[0].events / runs[0].passed


@pytest.mark.parametrize("count", [2, 3, 5, 400])
def test_few_and_many_arcs_run_to_the_end(count: int) -> None:
    run = compared(FlatCam(Oval()), count, False, 0.2)
    assert run.stop == "DURATION" and abs(run.residual) < 1e-6
