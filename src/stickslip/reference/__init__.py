"""Independent solutions to compare the engine with: closed forms, and a slow integrator that shares no code with it."""
