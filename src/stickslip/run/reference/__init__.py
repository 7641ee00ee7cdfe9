"""Independent solutions to compare the engine with: closed forms, and slow methods for a fault in 2D and 3D."""
