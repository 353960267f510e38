"""What the player of a page needs: outlines, motion, events, forces, packed small."""
