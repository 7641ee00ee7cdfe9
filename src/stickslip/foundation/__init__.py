"""The lowest room: errors, units, declared quantities, and files that are written completely or not at all.

- `errors`, `arguments`: `InputError`, the one error that users see, with what was probably meant; what functions are given.
- `quantities`: a field of a body, a law or a loading is declared once, with its unit, its range and its meaning.
- `conversion`, `units`, `meant`: a number, a text with a unit or a quantity of pint becomes a number in SI.
- `names`, `given`: what each quantity is called, its symbol and unit, and the units of shown results.
- `show`: numbers with units, tables and dataclasses as text for people.
- `axis`, `other_values`: a parameter with its range, and problems with other numbers.
- `atomic_write`, `netcdf_file`, `zarr_folder`, `locks`, `sealed_files`: files and folders that are whole or not there.
- `record_files`, `text_columns`, `named_columns`, `headings`, `marks`, `columns`, `unit_doubts`: tables of measurements.
- `lazy_names`, `classes_by_kind`, `code_key`: names and classes that are imported when they are used, and a hash of code.
- `arrays`, `constants`, `place`, `synonyms`, `memory`: what many rooms share.
"""
