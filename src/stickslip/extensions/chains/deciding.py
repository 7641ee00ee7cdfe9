"""Which code decides the result of the run of a chain: kept runs and sweeps go on with no other."""

DECIDING = ("numbers", "couplings", "drawn", "solver", "state")
"""Modules whose code decides the result of a run, beside compiled code."""
DECIDING_CODE = tuple(f"extensions/chains/{one}" for one in ("compiled", *(f"{name}.py" for name in DECIDING)))
"""The code that decides the result of a run, beside the engine's."""
