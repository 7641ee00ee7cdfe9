"""Figures of single runs: curves, energy, the inside of the slab, films, and catalogues of slip events."""
