"""How does something get onto a disk whole, or not at all, and what becomes of it when the process is killed half way?

In: bytes and destinations. Out: files and folders that are whole, or errors that say why not. Imports `stopping` only.
"""
