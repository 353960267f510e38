"""What the event loop reads and writes: its state, its room to work in, and the buffers of what is kept."""
