"""Time: smooth steps, events and the loop that joins them."""
