"""How browsers reach the explorer, and who may: the server, its limits, and the workers beside its pages."""
