"""Figures of studies: several runs side by side, analogies, ensembles and regularisations."""
