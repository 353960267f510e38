"""What a frame shows besides the parts themselves: words, numbers, arrows, insets, a strip of curves."""
