"""Single pictures: a drawing, a scene at its start, a mechanism turned by hand, the geometry of function of an escapement."""
