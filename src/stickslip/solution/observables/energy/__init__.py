"""Energy of a run, of its slip events and of their pulses."""
