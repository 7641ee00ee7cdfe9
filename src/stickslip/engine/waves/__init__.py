"""The load that arrives at the contact: echoes, and loading that varies in time."""
