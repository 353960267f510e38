"""From a trajectory to numbers: beats, rates, energy, phases."""
