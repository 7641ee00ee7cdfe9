"""Read, check, correct and resample a laboratory record; find its noise, features and loading."""
