"""Random planar mechanisms, and a judge that needs no reference solution. See docs/reports/hunt.md."""
