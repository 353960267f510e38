"""Which cycles does a mechanism have, stable or not, and which swings lead to which?"""
