"""What does each command of `watchsim` do? One file a command: its options, and what it calls."""
