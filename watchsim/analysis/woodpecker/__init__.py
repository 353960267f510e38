"""Does the woodpecker toy come out?"""
