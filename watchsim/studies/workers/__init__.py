"""Who computes the points of a study, and what is kept if one of them is cut off?

In: points. Out: their rows, in this process, in others or on a cluster (`choose_executor`), each on the disk before the next
(`journal`). Imports `studies.point` and below.
"""
