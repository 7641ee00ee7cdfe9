"""The design of a sweep: its members, and the results that are kept for each of them."""
