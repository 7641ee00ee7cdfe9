"""The store of a sweep, and what is derived from its contents."""
