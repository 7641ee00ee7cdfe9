"""Rigid bodies: the whole body slips as one, on a spring whose other end is pulled."""
