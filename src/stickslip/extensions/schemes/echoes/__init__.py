"""The ways of waves from a contact through layers to drivers and back, for each kind of body a module."""
