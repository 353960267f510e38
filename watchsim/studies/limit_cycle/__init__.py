"""Where does a mechanism settle? Its return map, the cycle that closes, its stability, or what there is instead."""
