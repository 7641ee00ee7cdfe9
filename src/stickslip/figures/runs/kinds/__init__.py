"""What figures of runs show of each kind of body: a module for each, whose `ANSWERS` answer `DrawnKind`."""
