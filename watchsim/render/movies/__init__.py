"""How does a run become a film: which instants, at what pace, in which file format?"""
