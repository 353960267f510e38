"""The timing sheet of a page: amplitude, rate and beat error, phases, parameters."""
