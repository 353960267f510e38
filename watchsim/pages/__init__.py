"""One page that shows a run: a player, linked plots and the timing sheet, in a single file that opens anywhere."""
