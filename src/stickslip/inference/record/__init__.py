"""A laboratory record: columns that are read, put right, resampled, and looked at for noise, memory, features and loading."""
