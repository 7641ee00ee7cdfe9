"""The lowest room: errors, units, declared quantities, and files that are written completely or not at all.

Its modules are its doors:

- `errors`: `InputError`, the one error that users see, `nearest` for what was probably meant, and `warn`.
- `arguments`: checks of what public functions are given, and `shown`, which says it in a message.
- `quantities`: a field of a body, a law or a loading is declared once, with its unit, its range and its meaning.
- `conversion`, `units`, `meant`: a number, a text with a unit or a quantity of pint becomes a number in SI.
- `names`: what each quantity is called, its symbol and its unit, and the units in which numbers are readable.
- `given`: a number remembers the unit in which it was given, and results are shown in it.
- `show`: numbers with units, tables and dataclasses as text for people.
- `axis`, `other_values`: a parameter with its range, and problems with other numbers.
- `atomic_write`, `netcdf_file`, `zarr_folder`, `locks`: files and folders that are whole or not there.
- `record_files`, `text_columns`, `named_columns`, `headings`, `marks`, `columns`, `unit_doubts`: tables of measurements.
- `determined`: what measured points determine of fitted numbers.
- `arrays`, `constants`, `place`, `synonyms`, `memory`: small things that many share.
- `lazy_names`: the names of a package are imported when they are first used.
"""
