"""One step of the contact: at rest, in slip, across knots and folds."""
