"""What does a user get when no method solves a complementarity problem?"""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
from interpreter import ROOT

SCRIPT = """
from watchsim.dynamics import acceleration, impact
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.problem_kinds import Rung

def unsolvable(work, m, elements):
    work.posed.lemke = LcpOutcome.RAY
    work.rungs[Rung.FAILED] += 1
    return Rung.FAILED

impact.solve_contacts = acceleration.solve_contacts = unsolvable
from watchsim.cli import main
import sys
sys.exit(main(["run", sys.argv[1], "-o", sys.argv[2]]))
"""
SCENE = """
[scene]
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.disc]
circle = "10 mm"
motion = "free"
mass = "1 g"
inertia = "50 g·mm²"
position = ["0 mm", "20 mm"]
velocity = ["0.1 m/s", "0 m/s"]
[bodies.ground]
line = [["1 m", "0 mm"], ["-1 m", "0 mm"]]
motion = "fixed"
[[contacts]]
between = ["disc", "ground"]
friction = 0.3
[run]
duration = "1 s"
"""


def test_the_run_is_kept_with_the_problem_and_what_to_try(tmp_path) -> None:
    scene, folder = tmp_path / "scene.toml", tmp_path / "results"
    scene.write_text(SCENE, encoding="utf-8")
    command = [sys.executable, "-c", SCRIPT, str(scene), str(folder)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, env=environment, cwd=ROOT, check=False, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 3, done.stderr
    assert "lcp_failure.json" in done.stderr
    failure = json.loads((folder / "lcp_failure.json").read_text(encoding="utf-8"))
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    fall = np.sqrt(2.0 * 0.01 / 9.81)
    assert failure["level"] == "compression"
    assert failure["lemke_ended_with"] == "ray"
    assert failure["t"] == float(np.float64(summary["simulated_s"]))
    assert abs(failure["t"] - fall) < 1e-9
    (contact,) = failure["contacts"]
    assert abs(contact["gap_rate_m_per_s"] + 9.81 * fall) < 1e-8
    assert "disc.circle" in contact["between"]
    # The disc's own numbers: 1/m for both directions and the radius squared over the inertia for the tangential one.
    np.testing.assert_allclose(failure["G"], [[1e3, 0.0], [0.0, 1e3 + 0.01**2 / 5e-8]], rtol=1e-12, atol=1e-9)
    # In the directions of the contact, whichever way round the problem has them.
    np.testing.assert_allclose(failure["b"], [contact["gap_rate_m_per_s"], contact["slip_m_per_s"]], rtol=1e-12)
    sign = np.where(np.isin(np.arange(2), failure["reversed"]), -1.0, 1.0)
    np.testing.assert_allclose(failure["rhs"][1] / failure["rhs"][0], (sign * failure["b"])[1] / failure["b"][0], rtol=1e-12)
    assert abs(abs(contact["slip_m_per_s"]) - 0.1) < 1e-12
    assert len(failure["A"]) == len(failure["rhs"]) == 3
    assert failure["what_to_try"]
    assert (folder / "trajectory.npz").is_file()
    assert summary["lcp_failures"] == 1
    assert summary["stop"] == "LCP_FAILED"
