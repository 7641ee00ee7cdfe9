"""Commands of given motion."""
