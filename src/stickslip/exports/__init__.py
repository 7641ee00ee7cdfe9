"""Time series of a run in the formats of seismologists and rupture modellers."""
