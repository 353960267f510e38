"""What happens in a beat: phases with their angles, velocities, impulses and energies."""
