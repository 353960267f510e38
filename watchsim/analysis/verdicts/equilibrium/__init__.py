"""How do the bodies of a watch that stands hold each other: lever arms, contacts in force, torques?"""
