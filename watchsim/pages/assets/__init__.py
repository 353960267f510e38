"""What runs in the browser?

Template, style sheet and scripts of the page, one file a question; no Python but this.
"""
