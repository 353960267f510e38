"""Why did the loop stop? Each cause carries its sentence."""

from __future__ import annotations

from enum import IntEnum


class Stop(IntEnum):
    """Cause of a return from the event loop. RUNNING to BUFFER_FULL and LAST_STEP never reach a user."""

    RUNNING = 0
    SLICE = 1
    CELL_UNKNOWN = 2
    BUFFER_FULL = 3
    DURATION = 4
    INTERRUPTED = 5
    TOO_MANY_EVENTS = 6
    LCP_FAILED = 7
    STEP_TOO_SMALL = 8
    NOT_FINITE = 9
    TOO_MANY_CONTACTS = 10
    LAST_STEP = 11
    OUT_OF_MEMORY = 12
    FAR_AWAY = 13
    OVERLAP = 20
    UNEXPLAINED = 21
    LEDGER = 22

    @property
    def sentence(self) -> str:
        """The cause in words."""
        return _SENTENCES[self]

    @property
    def is_wrong(self) -> bool:
        """True when a check that the run makes of itself says that its result is wrong."""
        return self in (Stop.OVERLAP, Stop.UNEXPLAINED, Stop.LEDGER)

    @property
    def gave_up(self) -> bool:
        """True when the solver could not go on, or its result is known to be wrong (exit status 3)."""
        could_not = Stop.TOO_MANY_EVENTS <= self <= Stop.TOO_MANY_CONTACTS or self in (Stop.OUT_OF_MEMORY, Stop.FAR_AWAY)
        return could_not or self.is_wrong


_SENTENCES = {
    Stop.RUNNING: "still running",
    Stop.SLICE: "a slice of simulated time is done",
    Stop.CELL_UNKNOWN: "a cell of the configuration space was entered for the first time",
    Stop.BUFFER_FULL: "the record buffer is full",
    Stop.LAST_STEP: "the next step might reach the end",
    Stop.DURATION: "the requested duration was simulated",
    Stop.INTERRUPTED: "interrupted by the user; everything up to here is kept",
    Stop.TOO_MANY_EVENTS: "too many events at one instant: time does not advance",
    Stop.LCP_FAILED: (
        "no solution of a complementarity problem was found; lcp_failure.json holds it. Less friction or restitution at the "
        "contacts it names, or a tighter tolerance, may help"
    ),
    Stop.STEP_TOO_SMALL: "the step became too small for the requested tolerance",
    Stop.NOT_FINITE: "a coordinate or velocity is no longer a finite number",
    Stop.FAR_AWAY: "a body has gone so far that contacts are lost in the rounding of its position",
    Stop.OUT_OF_MEMORY: "there is no memory left to keep more; --record statistics needs the least",
    Stop.TOO_MANY_CONTACTS: "more contacts closed at once than there is room for",
    Stop.UNEXPLAINED: "velocities changed at an instant by more than the impulses there explain",
    Stop.LEDGER: "the energy ledger does not close",
    Stop.OVERLAP: "bodies overlapped, so the motion is wrong from there on at the latest",
}
