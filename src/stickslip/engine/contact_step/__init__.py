"""Advance the contact by one step: at rest, in slip, and across knots and folds."""
