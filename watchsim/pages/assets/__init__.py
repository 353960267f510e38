"""What runs in the browser?

Template, style sheet and scripts of the page, one file a question; no Python but this. In: the data that `player` packs into
the page. Out: player, plots and tables on the screen. Imports nothing.
"""
