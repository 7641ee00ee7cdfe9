"""The contact at one moment: friction, the contact equation, the place on the load, and the record in the history."""
