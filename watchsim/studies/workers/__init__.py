"""Who computes the points of a study, and what is kept if one of them is cut off?"""
