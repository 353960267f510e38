"""How is a recoil anchor escapement with its pendulum drawn?

In: its dimensions, the dead-beat ones and the recoil. Out: what `construction.graham` draws of them. Imports `construction`
and below.
"""
