"""What happens between a save and what the page shows of it?"""
