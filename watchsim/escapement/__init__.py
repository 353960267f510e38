"""What does a drawn escapement do by its geometry alone: lock, draw, lift, drop, freedoms?"""
