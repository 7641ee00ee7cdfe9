"""Make friction laws from what users supply: expressions, Python functions and measured points."""
