"""Conversion of a problem to the numbers that the engine works on."""
