"""Figures of the contact: friction laws, the resistance g(v), the admissible set K, and the regimes."""
