"""Show results on the terminal, and check and write files."""
