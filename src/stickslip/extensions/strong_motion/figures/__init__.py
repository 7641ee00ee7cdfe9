"""Figures of strong motion: displacements of many records, and the motion under one."""
