"""What is a wheel's mean speed over a whole number of teeth?"""

import math

import numpy as np

from watchsim.simulation.trajectory import Trajectory


def when(run: Trajectory, column: int, angle: float) -> float:
    """The time at which a coordinate that grows passes `angle`, s."""
    i = int(np.searchsorted(run.q[:, column], angle))
    low, high = float(run.t[i - 1]), float(run.t[i])
    for _ in range(60):
        middle = 0.5 * (low + high)
        if float(run.sample(np.array([middle]))[0][0, column]) < angle:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def tooth_times(run: Trajectory, column: int, teeth: int, after: float) -> np.ndarray:
    """When each tooth after the transient passes, s."""
    pitch = 2.0 * math.pi / teeth
    first = math.ceil(float(run.q[np.searchsorted(run.t, after), column]) / pitch)
    last = math.floor(float(run.q[-1, column]) / pitch)
    return np.array([when(run, column, pitch * k) for k in range(first, last + 1)])


def mean_speed(run: Trajectory, column: int, teeth: int, after: float) -> float:
    """rad/s."""
    times = tooth_times(run, column, teeth, after)
    return 2.0 * math.pi / teeth * (len(times) - 1) / float(times[-1] - times[0])
