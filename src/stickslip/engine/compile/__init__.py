"""Compile kernels, and keep their machine code on disk."""
