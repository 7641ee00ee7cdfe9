# What others take from solution.files. Each name is imported when it is first used; all else is the room's own.

from stickslip.solution.files.catalogue_rows import (
    Rows,  # The rows of a table in a CSV file, which stores every number to the last digit.
    RowsInMemory,  # The rows of a table that goes to no file, with the interface of `Rows`.
    check_catalogue,  # Refuse a file name whose suffix is unknown or whose format needs a library that is missing.
    read_table,  # Read a finished catalogue.
)
from stickslip.solution.files.curves import (
    checked_path,  # Return the path of a file of curves.
    heading,  # Return the heading of a column: "slip rate (m/s)"; that of a pure number has no unit.
    # Write columns of numbers as CSV with all digits, whole or not at all, and return the path; NaN is an empty cell.
    write_columns,
)
from stickslip.solution.files.netcdf import (
    CATALOGUE,  # Attribute that holds the version in the checkpoint of a catalogue.
    FILE_FORMAT,  # Version of the file layout below; a file with another version is refused.
    about_curves,  # Return the attributes units and long_name of each curve of a run, and of its time.
    is_catalogue,  # Return True if a file is the checkpoint of a catalogue.
    origin,  # Return the attributes that say where a run comes from, but for those that take a computation.
    read,  # Read a netCDF file of stickslip whose version is stored in the attribute `kind`.
    read_solution,  # Read a solution from a netCDF file, and raise InputError, as `open_solution` does.
    # Write only what `open_solution` and `resume` need of a run under way, without curves and tables, to save time.
    save_checkpoint,
    to_solution,  # Return the solution in a dataset that was read from `path`.
)
from stickslip.solution.files.soundness import (
    check_place,  # Return what a catalogue's checkpoint says of its rows and of the stream of events.
    number,  # Return an attribute that must be a finite number, at least `lowest`.
    whole_number,  # Return an attribute that must be a whole number from `lowest` to `highest`.
)
from stickslip.solution.files.zarr_store import (
    FolderFormat,  # One of the `KINDS` of folders, with the version of its layout.
    check_layout,  # Refuse arrays of another form than those of a layout, but for the number of rows of those that grow.
    # Let `lay_out` fill a folder under a temporary name, then rename it to `path`, so that it appears complete or not at all.
    create,
    is_sound,  # Return True if a file is a chunk that ends in its checksum.
)

__all__ = [
    "CATALOGUE",
    "FILE_FORMAT",
    "FolderFormat",
    "Rows",
    "RowsInMemory",
    "about_curves",
    "check_catalogue",
    "check_layout",
    "check_place",
    "checked_path",
    "create",
    "heading",
    "is_catalogue",
    "is_sound",
    "number",
    "origin",
    "read",
    "read_solution",
    "read_table",
    "save_checkpoint",
    "to_solution",
    "whole_number",
    "write_columns",
]
