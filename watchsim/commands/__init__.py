"""What does each command of `watchsim` do? One file a command: its options, and what it calls.

In: parsed arguments. Out: an exit status, text for people or one JSON object. What several commands need is in
`commands.common`, what a second core does in `commands.beside`. Imports everything below, but only when a command runs:
`watchsim --help` answers at once.
"""
