"""Implicit steps, for laws with a state and for stiff contacts: collocation at Radau's points."""
