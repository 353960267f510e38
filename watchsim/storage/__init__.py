"""How does something get onto a disk whole, or not at all, and what becomes of it when the process is killed half way?"""
