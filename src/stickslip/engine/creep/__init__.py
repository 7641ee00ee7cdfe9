"""Leaps over creep under a law of slip, and over slow and steady sliding: theory, landing, and when to leap."""
