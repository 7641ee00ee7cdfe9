"""How a run of each kind of body is compared with another one, a module for each."""
