"""What a fit asks of each kind of body: a module for each, whose `ANSWERS` answer `FittedKind`."""
