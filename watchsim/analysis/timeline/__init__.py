"""What happens in a beat: phases with their angles, velocities, impulses and energies?

In: a `Trajectory` and its contact forces. Out: rows of phases and their printed tables. Imports `analysis.timing`,
`analysis.contact_forces`, `simulation` and below.
"""
