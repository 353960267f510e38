"""Which events of the wheel mark the phases of a beat?"""
