"""Where do the contact problems of one island work? Room allocated once, by owner; no kernel here takes all of it."""

from __future__ import annotations

from typing import NamedTuple

from watchsim.dynamics.delassus import ContactSystem, ContactSystemRef, contact_system
from watchsim.dynamics.friction import FrictionProblem, FrictionProblemRef, friction_problem, problem_size
from watchsim.dynamics.impact import ImpactPhases, ImpactPhasesRef, impact_phases
from watchsim.dynamics.lcp import LcpWorkRef, lcp_work
from watchsim.dynamics.redundant import FreeForcesRef, ModeSystem, ModeSystemRef, mode_system
from watchsim.jit import by_reference, inlined


class ContactWork(NamedTuple):
    """What is written to, and by whom."""

    system: ContactSystem  # what acts on the gaps, and the contact forces: whoever poses a problem
    modes: ModeSystem  # the equality system of decided modes: `solve_mode`
    problem: FrictionProblem  # the complementarity problem: `decide_modes`, `impact`, `plastic_impact`
    phases: ImpactPhases  # impulses and rates of an impact: `impact`, `plastic_impact`


ContactWorkRef = by_reference(ContactWork, __name__)


def contact_work(room: int, coordinates: int) -> ContactWork:
    """Room for that many closed contacts."""
    lcp = lcp_work(problem_size(room, coordinates))
    return ContactWork(
        contact_system(room, coordinates),
        mode_system(room, coordinates, lcp),
        friction_problem(room, coordinates, lcp),
        impact_phases(room),
    )


@inlined
def contact_work_by_reference(work):
    """As nested structs."""
    modes, problem = work.modes, work.problem
    return ContactWorkRef(
        ContactSystemRef(*work.system),
        ModeSystemRef(FreeForcesRef(LcpWorkRef(*modes.redundant.lcp), *modes.redundant[1:]), *modes[1:]),
        FrictionProblemRef(LcpWorkRef(*problem.lcp), *problem[1:]),
        ImpactPhasesRef(*work.phases),
    )
