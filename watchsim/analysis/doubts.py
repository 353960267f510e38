"""Why should the numbers of a run not be trusted?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.mechanism.compile import scene_size
from watchsim.simulation.methods import MOREAU
from watchsim.simulation.record.trajectory import Trajectory

UNSOLVED = 1e-6  # share of a contact problem's largest term: what rounding leaves lies far below
COARSE = 5e-3  # overlap as a share of the mechanism's size, beyond which a step has lost the shapes that touch
FINER = 5.0  # so much shorter a step to try


def doubts(run: Trajectory) -> Iterator[str]:
    """A sentence for each reason: contact problems left unsolved, a step too coarse for the motion."""
    if run.worst_residual > UNSOLVED:
        yield (
            f"a contact problem was left with a residual of {run.worst_residual:.2g} of its largest term, "
            "so forces and impulses there are not those of the laws of contact"
        )
    deep = COARSE * scene_size(run.scene)
    if run.method == MOREAU and run.step is not None and run.worst_penetration > deep:
        yield (
            f"the step of {1e6 * run.step:.4g} µs is too coarse: bodies overlapped by {1e6 * run.worst_penetration:.2g} µm. "
            f'Take a shorter one, such as --step "{1e6 * run.step / FINER:.2g} µs", until the numbers no longer change'
        )
