"""The tour as a folder of plain files, which a browser shows without Python and without a network."""
