"""What everything else rests on: errors, units, quantities, files that appear whole or not at all."""
