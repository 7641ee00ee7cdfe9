"""The contact at one moment: friction, the contact equation, the place on the load, and what a step leaves in the history."""
