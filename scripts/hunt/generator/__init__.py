"""Which mechanisms does the hunt try? Drawn from a seed: outlines, pivots, slides, material."""
