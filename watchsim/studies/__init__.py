"""What is the watch's own answer? Limit cycles, sweeps over parameters, sensitivities: many short simulations, one table."""
