"""Figures of chains: rupture in space and time, catalogues, the frequency of magnitudes, energies, and chain beside slab."""
