"""Tables as instruments write them: headings are found by the numbers below them, whatever the instrument writes before."""

import struct
from pathlib import Path

import numpy as np
import pytest

from stickslip.foundation.columns import Table
from stickslip.foundation.errors import InputError
from stickslip.foundation.text_columns import read_file, read_text

WANTED = ("time", "slip", "slip_rate", "load_point", "friction", "shear_force", "normal_force")
TIMES = np.arange(30) / 10.0
SLIPS = TIMES * 0.37
FORCES = 12.0 + np.sin(TIMES)


def rows(separator: str, *, comma: bool = False, end: str = "\n") -> str:
    """Return three columns of the numbers above, with four decimals."""
    lines = (separator.join(f"{one:.4f}" for one in row) for row in zip(TIMES, SLIPS, FORCES, strict=True))
    return "".join((line.replace(".", ",") if comma else line) + end for line in lines)


TESTER = f"""\ufeffUniversal testing machine: model 7, serial 20114
Operator: A. B., 2024-03-12 10:15:01
Specimen no.,7
Specimen geometry,block 40,60,20
Test speed,5,mm/s
Preload,2.5,N
"Comment","pulled, twice: at 5, 10"
Load cell,100,N
Sampling,50,Hz

Results,Max load,Friction
1,13.0,0.31
Time,Slip,Force
(s),(mm),(kN)
{rows(",")}
End of test: stopped by operator
"""
ENCODER = f"""Messung;Encoderlog
Datum;12.03.2024
Uhrzeit;10:15:01
Abtastrate;50;Hz
Weg pro Impuls;0,005;mm
Kanal 1;Kanal 2;Kanal 3;
Time;Slip;Force;
s;mm;kN;
{rows(";", comma=True, end=";" + chr(10))}"""
SCOPE = f"""Record Length,30,points
Sample Interval,1.0E-1,s
Trigger Point,0,samples
Vertical Scale,0.5,V
Time,Displacement,Force
s,mm,kN
{rows(",")}"""
LABVIEW = f"""Rig v2.1\tbuild 118
Date\t2024/03/12
Time\t10:15:01,123456
Channels\t3
Samples\t30\t30\t30
X0\t0.0\t0.0
***End of header***
Time\tSlip\tForce
Dev1/ai0\tDev1/ai1\tDev1/ai2
[s]\t[mm]\t[kN]
{rows(chr(9))}"""
BLANKS = f"rig 4, run 12\ntest at 5 mm/s, 20 C\n\n   time      slip       force\n    s        mm         kN\n{rows('   ')}"
LOGS = {"tester": (TESTER, 13, 14), "encoder": (ENCODER, 7, 8), "scope": (SCOPE, 5, 6), "labview": (LABVIEW, 8, 10)}
LOGS |= {"blanks": (BLANKS, 4, 5), "quoted": (SCOPE.replace("Time,Displacement,Force", '"Time","Displacement","Force"'), 5, 6)}


def read(text: str, *, raw: bool = True) -> Table:
    """Return the table in a text."""
    return read_text(text, WANTED, "log.csv", 1000, raw=raw)


@pytest.mark.parametrize("name", LOGS)
def test_the_numbers_of_a_log_come_in_si_under_the_headings_above_them(name: str) -> None:
    text, header, units = LOGS[name]
    table = read(text)
    assert table.at_header == f"log.csv, line {header}"
    assert list(table.columns) == ["time", "slip", "shear_force"]
    np.testing.assert_allclose(table.columns["time"], TIMES, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(table.columns["slip"], SLIPS / 1e3, rtol=0.0, atol=0.6e-7)  # four decimals of a millimetre
    np.testing.assert_allclose(table.columns["shear_force"], FORCES * 1e3, rtol=0.0, atol=0.06)
    said = f"slip (column 2) is in mm, shear_force (column 3) is in kN, as the row of units in line {units} says"
    assert said in table.notes[0]
    assert not table.doubts


def test_a_traction_machine_writes_speeds_and_loads_with_commas() -> None:
    lines = "".join(f"{100 * i},0;{5 * i};{7 * i},5;{2 + 0.1 * i:.2f};20,0\n".replace(".", ",") for i in range(1, 12))
    head = "Mini traction machine;run 4\nBall;19,05;mm\nLoad;20;N\nStep;1;2;3\n\n"
    table = read(f"{head}Rolling speed;SRR;Sliding speed;Friction force;Normal load\nmm/s;%;mm/s;N;N\n{lines}")
    np.testing.assert_allclose(table.columns["slip_rate"], (7.0 * np.arange(1, 12) + 0.5) / 1e3, rtol=1e-12)
    np.testing.assert_allclose(table.columns["shear_force"], 2.0 + 0.1 * np.arange(1, 12), rtol=1e-12)
    assert set(table.columns["normal_force"]) == {20.0}
    assert "decimal commas are read as points" in table.notes


FAULTS = [
    (TESTER.replace("(kN)", "(mm)"), "line 14, column 3: the unit in the heading does not convert to N"),
    (SCOPE.replace("0.2000,", "0.2000x,", 1), "line 9: time must be a number, got text"),
    (ENCODER.replace("Time;Slip;Force;", "Time;Slip;Slip;"), "line 7: columns 2 and 3 both are the slip"),
    (SCOPE.replace("\n0.3000", "\nstopped\n0.3000", 1), "line 10: time must be a number, got text"),
    (SCOPE + "0.1,abc,0\n", "line 37: slip must be a number, got text"),
]


@pytest.mark.parametrize(("text", "message"), FAULTS)
def test_a_fault_names_its_own_line_and_never_the_first(text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        read(text)
    assert str(error.value).startswith(f"log.csv, {message}")


def test_a_column_that_is_missing_is_missed_in_the_line_of_the_headings() -> None:
    table = read(ENCODER.replace("Slip;Force", "Weg;Kraft"))
    assert (table.at_header, list(table.columns)) == ("log.csv, line 7", ["time"])
    table = read(SCOPE.replace("Time,Displacement,Force", "Zeit,Weg,Kraft"))
    assert (table.at_header, list(table.header)) == ("log.csv, line 5", ["Zeit", "Weg", "Kraft"])


def test_words_at_the_end_are_said_wherever_no_note_tells_of_them() -> None:
    with pytest.warns(UserWarning, match="log.csv: what follows line 44 has no numbers: passed over"):
        assert len(read(TESTER, raw=False).columns["time"]) == len(TIMES)


SOUND = b"RIFF" + struct.pack("<I", 36) + b"WAVEfmt " + bytes(28)
BINARY = {"a sound (.wav)": SOUND, "a database of SQLite": b"SQLite format 3\x00" + bytes(84)}


@pytest.mark.parametrize("name", BINARY)
def test_a_file_that_is_no_text_is_named_with_a_way_to_text(tmp_path: Path, name: str) -> None:
    path = tmp_path / "log.dat"
    path.write_bytes(BINARY[name])
    with pytest.raises(InputError) as error:
        read_file(path, WANTED, (10**6, 1000))
    assert f"{name}, which is not read: make CSV of it: `python -c" in str(error.value)
