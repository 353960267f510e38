"""How does a drawing become a scene, as far as a drawing can tell?

In: drawings of parts or of a whole assembly. Out: a commented scene file, with the drawings it needs, in which every guess is
marked as one. Everything is geometry and names; nothing is simulated. Imports `analysis`, `scene` and below.
"""
