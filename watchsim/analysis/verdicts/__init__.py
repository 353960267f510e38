"""Does the watch work, and if not, what is wrong with it?"""
