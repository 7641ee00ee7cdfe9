"""Figures that the paper alone has: its two systems and laws, its set K, and runs side by side."""
