"""Provide the compiler and its cache, and generate the code of each friction formula."""
