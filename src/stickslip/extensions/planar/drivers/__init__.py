"""The drivers of planar slabs: a module for each kind, whose `ANSWERS` answer `PlanarDriver`."""
