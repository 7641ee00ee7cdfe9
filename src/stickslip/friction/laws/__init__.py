"""Friction laws, one a file; the registry beside this folder lists them."""
