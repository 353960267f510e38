"""How does Moreau's time stepping run on the same model? The independent twin of the event-driven solver."""

from __future__ import annotations

import dataclasses
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.model.named_fields import blank, row_of
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.loop_state.buffers import Until, new_record
from watchsim.simulation.loop_state.state import room_for
from watchsim.simulation.methods import MOREAU
from watchsim.simulation.moreau.step_work import moreau_work
from watchsim.simulation.moreau.steps import EVENTS_PER_CONTACT, ROWS_PER_STEP, Pace, advance_fixed
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.runner import EVENTS, ROWS, Run
from watchsim.simulation.stops import Stop

ROWS_PER_QUARTER = 300  # of the fastest spring's period; of the scene's duration where there is no spring


class MoreauRun(Run):
    """Fixed steps of `step` seconds; impacts, friction and forces once for each."""

    method = MOREAU

    def __init__(self, scene: Scene, compiled: Compiled, tolerance: float, recording: Recording, step: float) -> None:
        super().__init__(scene, compiled, tolerance, recording)
        self.step = step
        self.pace = blank(Pace)
        self.pace.step, self.pace.row = step, max(step, self.options.max_step / ROWS_PER_QUARTER)
        self.work = moreau_work(compiled.model)
        self.record = new_record(
            compiled.model, ROWS + ROWS_PER_STEP, EVENTS + EVENTS_PER_CONTACT * room_for(compiled.model), self.record.windows
        )

    def begin_from(self, saved: SavedState) -> None:
        if "row_time" not in saved.arrays:  # earlier versions kept it with the times
            saved = dataclasses.replace(saved, arrays=saved.arrays | {"row_time": saved.arrays["clock"][2:]})
        super().begin_from(saved)

    def arrays(self) -> dict[str, NDArray[Any]]:
        kept = row_of(self.work.kept)
        own = {name: kept[name] for name in ("depth", "sweeps", "row_time")}
        return {**super().arrays(), "memory": self.work.memory, **own}

    def worst_residual(self) -> NDArray[np.float64]:
        return cast(NDArray[np.float64], row_of(self.work.kept)["violation"])

    def settings(self) -> dict[str, Any]:
        return {**super().settings(), "step": self.step}

    def _advance(self, until: Until, record: Any) -> Stop:
        model = self.compiled.model
        # Of fixed length, so that their number is a time.
        before = float(self.state.clock.time)
        until.slice_end = min(until.slice_end, before + until.steps * self.pace.step)
        code = advance_fixed(model, self.finder.cells, self.state, self.options, until, self.pace, self.work, record)
        until.steps -= round((float(self.state.clock.time) - before) / self.pace.step)
        return Stop(int(code))

    def _learn(self) -> None:
        self.finder.learn(int(self.work.asked.cell.pair), self.work.asked.at.copy(), self.state.u)

    def counts(self) -> dict[str, int]:
        return {**super().counts(), "sweeps": int(self.work.kept.sweeps)}

    def _ledger_fails(self) -> bool:
        """Never: the error of the ledger goes with the step, which the user has chosen."""
        return False

    def _dissipated(self) -> dict[str, float]:
        return {**super()._dissipated(), "stepping": float(self.state.sums.correction)}
