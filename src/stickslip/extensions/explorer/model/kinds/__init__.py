"""What the explorer shows of each kind of body: a module for each, whose `ANSWERS` answer `ShownKind`."""
