"""Studies that need a single problem or run: critical values, predictability and the statistics of a catalogue."""

from stickslip.contact.critical import critical_value
from stickslip.observables.event_table import catalogue_statistics
from stickslip.observables.predictability import predictability

__all__ = ["catalogue_statistics", "critical_value", "predictability"]
