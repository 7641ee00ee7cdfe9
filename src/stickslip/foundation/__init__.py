"""The bottom layer: errors, units, physical quantities, and files that are written completely or not at all."""
