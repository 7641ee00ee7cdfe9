"""Bodies of layers: waves are sent back on their way, too, where layers meet, and drag takes of them."""
