"""How do bodies move between two events, smoothly?

In: a state and the contacts in force. Out: one step with its dense output: closed form where nothing couples bodies, DOP853
where contacts do, and when in it a contact mode ends (`contact_mode_end`). Imports `simulation.record.write_buffers`,
`simulation.loop_state`, `dynamics` and below.
"""
