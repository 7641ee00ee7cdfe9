"""What `check` says of each kind of body: a module for each, whose `ANSWERS` answer `CheckOfKind`."""
