"""What the user declares (bodies, forces, contacts) and what the kernels read."""
