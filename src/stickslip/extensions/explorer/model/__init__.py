"""What the explorer shows: the setting of its controls, the answer to it, links, differences and strips. No graphics."""
