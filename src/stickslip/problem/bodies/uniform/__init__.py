"""Uniform bodies with waves: what slips comes back once, from the driver."""
