"""Figures of studies: several runs side by side, analogies and ensembles."""
