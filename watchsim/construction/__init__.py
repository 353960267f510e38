"""How is a mechanism drawn from its dimensions? Designs: numbers in, outlines and the text of a scene out."""
