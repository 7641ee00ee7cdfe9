"""Files that are no text: what their first bytes say they are, and the way from there to text."""

from __future__ import annotations

import codecs
import re
from typing import NamedTuple

from stickslip.foundation.errors import InputError

OLD_LETTERS = "stickslip-or-latin-1"
"""What decodes bytes that are not UTF-8, as programs write µ and ° that know neither."""


def _python(code: str) -> str:
    return f'`python -c "{code}"`'


class Foreign(NamedTuple):
    """A kind of file: the pattern of its first bytes, its name, and the way to text, with what that needs."""

    begins: bytes
    name: str
    way: str
    needs: str = ""


_SHEET = "save its sheet as CSV in UTF-8"
_FROM_MAT = (
    "import scipy.io, pandas; m = scipy.io.loadmat('FILE', squeeze_me=True); "
    "pandas.DataFrame({k: v for k, v in m.items() if k[0] != '_'}).to_csv('FILE.csv', index=False)"
)
_FROM_TDMS = (
    "from nptdms import TdmsFile; "
    "TdmsFile.read('FILE').groups()[0].as_dataframe(time_index=True).to_csv('FILE.csv', index_label='time (s)')"
)
_FROM_SEISMIC = (
    "import obspy, pandas; s = obspy.read('FILE'); "
    "pandas.DataFrame({'time (s)': s[0].times(), **{f'{i + 1}': t.data for i, t in enumerate(s)}}).to_csv('FILE.csv', index=False)"
)
_FROM_58B = (
    "import pyuff, pandas; s = pyuff.UFF('FILE').read_sets(0); "
    "pandas.DataFrame({'time (s)': s['x'], s['id1']: s['data']}).to_csv('FILE.csv', index=False)"
)
_FROM_MDF = "from asammdf import MDF; MDF('FILE').export('csv', 'FILE.csv', single_time_base=True, add_units=True)"
_FROM_MAT73 = "import mat73, pandas; pandas.DataFrame(mat73.loadmat('FILE')).to_csv('FILE.csv', index=False)"
_FROM_HDF5 = "import h5py, pandas; f = h5py.File('FILE'); pandas.DataFrame({k: f[k][:] for k in f}).to_csv('FILE.csv', index=False)"
_FROM_WAVE = (
    "import scipy.io.wavfile, pandas; r, y = scipy.io.wavfile.read('FILE'); t = pandas.DataFrame(y); "
    "t.insert(0, 'time (s)', t.index / r); t.to_csv('FILE.csv', index=False)"
)
_FROM_SQLITE = "import sqlite3, pandas; pandas.read_sql('select * from TABLE', sqlite3.connect('FILE')).to_csv('FILE.csv')"
_FROM_PARQUET = "import pandas; pandas.read_parquet('FILE').to_csv('FILE.csv', index=False)"
_FROM_NUMPY = "import numpy; numpy.savetxt('FILE.csv', numpy.load('FILE'), delimiter=',', header='time (s),friction', comments='')"
FOREIGN = (
    Foreign(rb"(MDF|UnFinMF) ", "a measurement file of ASAM MDF (.mf4, .mdf, .dat)", _python(_FROM_MDF), "asammdf"),
    Foreign(rb"TDSm", "a file of LabVIEW in TDMS", _python(_FROM_TDMS), "npTDMS"),
    Foreign(rb"MATLAB 7\.3", "a file of MATLAB 7.3 (.mat)", _python(_FROM_MAT73), "mat73 pandas"),
    Foreign(rb"MATLAB ", "a file of MATLAB (.mat)", _python(_FROM_MAT), "scipy pandas"),
    Foreign(
        rb"\x00{4}.{8}[\x00\x01]\x00{3}[\x02-\x40]\x00{3}[A-Za-z]\w*\x00",
        "a file of MATLAB 4 (.mat)",
        _python(_FROM_MAT),
        "scipy pandas",
    ),
    Foreign(rb"(.{512}|.{1024}|.{2048})?\x89HDF\r\n\x1a\n", "a file of HDF5 or netCDF", _python(_FROM_HDF5), "h5py pandas"),
    Foreign(rb"(\xc3\x40{1,2}\xf1|C {0,2}1 [^\n]{72,77}C {0,2}2 )", "a file of SEG-Y", _python(_FROM_SEISMIC), "obspy pandas"),
    Foreign(rb"\d{6}[DRQM][ \x00]", "a file of miniSEED", _python(_FROM_SEISMIC), "obspy pandas"),
    Foreign(rb"\s*(-1\s+)+58b", "a universal file with binary datasets 58b", _python(_FROM_58B), "pyuff pandas"),
    Foreign(rb"PK\x03\x04", "a workbook (.xlsx, .ods) or another archive", _SHEET),
    Foreign(rb"\xd0\xcf\x11\xe0", "a workbook or document (.xls)", _SHEET),
    Foreign(rb"\x1f\x8b", "a file compressed by gzip", "`gunzip FILE`"),
    Foreign(rb"PAR1", "a table in Parquet", _python(_FROM_PARQUET), "pandas pyarrow"),
    Foreign(rb"\x93NUMPY", "an array of NumPy", f"{_python(_FROM_NUMPY)} with the headings of its columns"),
    Foreign(rb"RIFF.{4}WAVE", "a sound (.wav)", _python(_FROM_WAVE), "scipy pandas"),
    Foreign(rb"SQLite format 3\x00", "a database of SQLite", f"{_python(_FROM_SQLITE)} with the name of its table", "pandas"),
    Foreign(rb"%PDF", "a document in PDF", "ask for its numbers"),
)
"""The kinds of files that are known; `FILE` in a way stands for the file."""
_PATTERNS = tuple((re.compile(one.begins, re.DOTALL), one) for one in FOREIGN)


def check_is_text(begin: bytes) -> None:
    """Raise InputError, with the way to text, for the first bytes of a file that is known and no text.

    The message is meant to follow the name of the file.
    """
    found = next((one for pattern, one in _PATTERNS if pattern.match(begin)), None)
    if found is not None:
        needs = f" (pip install {found.needs})" if found.needs else ""
        raise InputError(f"{found.name}, which is not read: make CSV of it: {found.way}{needs}")


def _as_latin_1(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeDecodeError):
        raise error
    return error.object[error.start : error.end].decode("latin-1"), error.end


codecs.register_error(OLD_LETTERS, _as_latin_1)
