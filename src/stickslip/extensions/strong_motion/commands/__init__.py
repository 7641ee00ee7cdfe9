"""Commands of strong motion."""
