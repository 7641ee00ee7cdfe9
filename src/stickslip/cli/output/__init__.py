"""How results are shown and which files are written."""
