"""What does a run sound like?"""
