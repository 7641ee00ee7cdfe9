"""Slip events of a slab under the hyperbolic rate law, to 50 digits: what the engine is tested against.

    python tests/core/engine/truth/slab_events.py        writes the tables beside this file (a minute or two)

Nothing of the package is used, and another method: the engine follows polynomials of the load in time; here no function of
time is ever formed. The slab has a rigid driver, no contact mass, perfect delay (Campillo et al. 1996, eqs (12)-(13), section 3).
With e the load minus the static strength, theta the offset in a round trip and one round trip from row n to row n + 1:

    at rest    e -> e + ramp                                    ramp = 2 Z V
    slipping   e -> e - 2 Z v + ramp,    g(v) - g(0) = Z v - F alpha v / (1 + alpha v) = e,    F = S (muS - muD)
    at first   e = excess + ramp theta / R    in row 0

Rest ends where e > 0; slip ends where e falls below the fold of g, at v1 = (q - 1) / alpha, q^2 = alpha F / Z. So the load at
a phase is a composition of maps that are monotone, are known by the rows in which that phase has slipped, and can be
undone in closed form (a quadratic equation). A round trip is a ring of pieces of phase, each with such a history and with its
load at both ends: where a load meets a level is the level taken back through the history. Undoing a slip contracts, so that the
digits of such a phase hold; loads at ends are carried forwards, where slip multiplies an error by |1 - 2 Z / g'(v)|.
"""

from __future__ import annotations

import csv
import gzip
import heapq
import io
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from mpmath import floor, inf, log10, mp, mpf, nstr, quad, sqrt

DIGITS, MORE_DIGITS = 50, 70
"""A table is written only if both give the same digits."""
FEWER, MANY = 17, 25
"""Significant digits in the tables: of numbers, and of offsets, which tell micro-events apart."""


@dataclass(frozen=True)
class Slab:
    """The numbers that a run in double precision is given, which are exact here. SI units.

    The static coefficient minus the dynamic one is their difference as a double: exactly 0.5 for 0.8 and 0.3.
    """

    alpha: float
    density: float = 2800.0
    wave_speed: float = 3500.0
    thickness: float = 1e4
    normal_stress: float = 1e8
    static: float = 0.8
    dynamic: float = 0.3
    pull_rate: float = 0.05 / 31_557_600.0

    def contact(self) -> Contact:
        """The maps of a round trip, at the present precision."""
        impedance = mpf(self.density) * self.wave_speed
        return Contact(
            mpf(self.alpha),
            impedance,
            mpf(self.normal_stress) * (self.static - self.dynamic),
            2 * impedance * self.pull_rate,
            2 * mpf(self.thickness) / self.wave_speed,
        )


@dataclass(frozen=True)
class Contact:
    """alpha (s/m), Z (Pa s/m), F = S (muS - muD) (Pa), ramp = 2 Z V (Pa per round trip), R (s)."""

    alpha: mpf
    impedance: mpf
    fall: mpf
    ramp: mpf
    round_trip: mpf
    fold: mpf = field(init=False)
    """Load (minus the static strength, Pa) below which the contact cannot slip."""

    def __post_init__(self) -> None:
        q = sqrt(self.alpha * self.fall / self.impedance)
        object.__setattr__(self, "fold", -self.impedance / self.alpha * (q - 1) ** 2)

    def resistance(self, v: mpf) -> mpf:
        """g(v) - g(0)."""
        return self.impedance * v - self.fall * self.alpha * v / (1 + self.alpha * v)

    def rate(self, e: mpf) -> mpf:
        """The slip rate under a load: the larger root of Z alpha v^2 + (Z - (F + e) alpha) v - e = 0."""
        half = ((self.fall + e) * self.alpha - self.impedance) / 2
        room = half**2 + self.impedance * self.alpha * e
        return (half + sqrt(max(room, mpf(0)))) / (self.impedance * self.alpha)

    def echo(self, e: mpf) -> mpf:
        """What a load under which the contact slips has become one round trip later."""
        return e - 2 * self.impedance * self.rate(e) + self.ramp

    def rate_before(self, e: mpf) -> mpf:
        """The slip rate one round trip before: the larger root of Z alpha v^2 + (Z + (F + w) alpha) v + w = 0, w = e - ramp."""
        w = e - self.ramp
        half = ((self.fall + w) * self.alpha + self.impedance) / 2
        return (sqrt(half**2 - self.impedance * self.alpha * w) - half) / (self.impedance * self.alpha)

    def growth(self, v: mpf) -> mpf:
        """|1 - 2 Z / g'(v)|: what slip multiplies a disturbance of the load by."""
        slope = self.impedance - self.fall * self.alpha / (1 + self.alpha * v) ** 2
        return abs(1 - 2 * self.impedance / slope) if slope else inf


class Slips(NamedTuple):
    """The rows in which a phase has slipped: the last one, those before it, how many."""

    row: int
    before: Slips | None
    count: int


@dataclass
class Piece:
    """Phases from `start` to `end` with one history; loads at its ends in `row`, from which on they only rise by the ramp."""

    start: mpf
    end: mpf
    first: mpf
    last: mpf
    row: int
    slips: Slips | None
    next: Piece = field(init=False, repr=False)
    onset: int = -1
    """Row in which rest ends somewhere in the piece, if nothing comes before."""


class Event(NamedTuple):
    """One slip event: rows and offsets (s), slip (m), largest slip rate (m/s).

    `generation`: how often the phase at which it starts had slipped before. `growth`: decimal logarithm of what has become there
    of 1 Pa of a disturbance at t = 0; the slope of the load along the phase has grown as much since.
    """

    start_row: int
    start_offset: mpf
    end_row: int
    end_offset: mpf
    duration: mpf
    slip: mpf
    peak_rate: mpf
    generation: int
    growth: mpf


class Ring:
    """The pieces of a round trip, in the order of phase, and the rows in which rest ends in each."""

    def __init__(self, contact: Contact, excess: mpf | int = 0) -> None:
        self.contact = contact
        self.excess = mpf(excess)
        whole = Piece(mpf(0), contact.round_trip, self.excess, self.excess + contact.ramp, 0, None)
        whole.next = whole
        self.waiting: list[tuple[int, mpf, int, Piece]] = []
        self._wait(whole)

    def events(self) -> Iterator[Event]:
        """Slip events without end, in the order of time."""
        while True:
            row, start, _, piece = heapq.heappop(self.waiting)
            if piece.onset != row or piece.start != start:
                continue  # it has slipped since, or lost its beginning
            if self.loads(piece, row)[0] < 0:
                later = self._cut(piece, self.phase(piece, row, mpf(0)), row, mpf(0))
                self._wait(piece)
                piece = later
            yield self._event(piece, row)

    def loads(self, piece: Piece, row: int) -> tuple[mpf, mpf]:
        """Loads at the ends of a piece in a row."""
        raised = (row - piece.row) * self.contact.ramp
        return piece.first + raised, piece.last + raised

    def phase(self, piece: Piece, row: int, load: mpf) -> mpf:
        """The offset at which the load of a piece has a value in a row."""
        return self.back(piece.slips, row, load)[0]

    def back(self, slips: Slips | None, row: int, load: mpf) -> tuple[mpf, mpf]:
        """Offset of a load, and the growth of a disturbance there: back through all slips to the first round trip."""
        contact, growth = self.contact, mpf(1)
        while slips is not None:
            rate = contact.rate_before(load - (row - slips.row - 1) * contact.ramp)
            growth *= contact.growth(rate)
            load, row, slips = contact.resistance(rate), slips.row, slips.before
        return (load - self.excess - row * contact.ramp) * contact.round_trip / contact.ramp, growth

    def _wait(self, piece: Piece) -> None:
        """Note when rest ends in a piece."""
        top = max(piece.first, piece.last)
        piece.onset = piece.row + max(int(floor(-top / self.contact.ramp)) + 1, 0)
        heapq.heappush(self.waiting, (piece.onset, piece.start, id(piece), piece))

    def _cut(self, piece: Piece, where: mpf, row: int, load: mpf) -> Piece:
        """Split a piece where it has a load in a row; returns the later part."""
        first, last = self.loads(piece, row)
        later = Piece(where, piece.end, load, last, row, piece.slips)
        later.next, piece.next = piece.next, later
        piece.end, piece.first, piece.last, piece.row = where, first, load, row
        return later

    def _event(self, piece: Piece, row: int) -> Event:
        """Slip from the start of a piece on, through every piece under which the contact goes on slipping."""
        contact = self.contact
        generation = piece.slips.count if piece.slips else 0
        began, growth = (row, piece.start), self.back(piece.slips, row, self.loads(piece, row)[0])[1]
        slip = lasted = peak = mpf(0)
        while True:
            first, last = self.loads(piece, row)
            ends = last < contact.fold
            if ends:
                last = contact.fold
                later = self._cut(piece, self.phase(piece, row, last), row, last)
                self._wait(later)
            slip += self._slip(piece, row, first, last)
            lasted += piece.end - piece.start
            peak = max(peak, contact.rate(first), contact.rate(last))
            ended, following = (row, piece.end), piece.next
            row += piece.end == contact.round_trip
            self._pass(piece, ended[0], first, last)
            if ends or self.loads(following, row)[0] < contact.fold:
                return Event(*began, *ended, lasted, slip, peak, generation, log10(growth))
            piece = following

    def _pass(self, piece: Piece, row: int, first: mpf, last: mpf) -> None:
        """A whole piece has slipped in a row."""
        piece.first, piece.last = self.contact.echo(first), self.contact.echo(last)
        piece.row, piece.slips = row + 1, Slips(row, piece.slips, piece.slips.count + 1 if piece.slips else 1)
        self._wait(piece)

    def _slip(self, piece: Piece, row: int, first: mpf, last: mpf) -> mpf:
        """Integral of v over the piece, by parts: the phase is smooth in v, also at the fold."""
        rates = self.contact.rate(first), self.contact.rate(last)

        def rest(v: mpf) -> mpf:
            return self.phase(piece, row, self.contact.resistance(v)) - piece.start

        return rates[1] * (piece.end - piece.start) - quad(rest, rates, method="gauss-legendre")


def first_events(slab: Slab, count: int, digits: int = DIGITS) -> list[Event]:
    """The first events of a slab that is released at its static strength, worked out with so many digits."""
    with mp.workdps(digits):
        return list(islice(Ring(slab.contact()).events(), count))


@dataclass(frozen=True)
class Table:
    """A file of first events: how many, and of which slab."""

    name: str
    slab: Slab
    count: int

    @property
    def path(self) -> Path:
        """Where the file lies."""
        return Path(__file__).with_name(self.name)

    def rows(self, count: int | None = None, digits: int = DIGITS) -> list[tuple[str, ...]]:
        """The first rows as text; all by default."""
        return [row_of(event) for event in first_events(self.slab, count or self.count, digits)]

    def read(self) -> list[dict[str, str]]:
        """The rows of the file, by the names of COLUMNS."""
        with gzip.open(self.path, "rt", encoding="ascii", newline="") as text:
            return list(csv.DictReader(text))

    def write(self) -> None:
        """Write the file. Raises ArithmeticError if more digits would give another one."""
        rows = self.rows()
        if rows != self.rows(digits=MORE_DIGITS):
            raise ArithmeticError(f"{self.name}: {DIGITS} digits are too few")
        text = io.StringIO(newline="")
        csv.writer(text, lineterminator="\n").writerows([COLUMNS, *rows])
        self.path.write_bytes(gzip.compress(text.getvalue().encode("ascii"), mtime=0))


COLUMNS = ("start_row", "start_offset", "duration", "slip", "peak_rate", "generation", "growth")


def row_of(event: Event) -> tuple[str, ...]:
    """An event as a row of a table: whole round trips, s, s, m, m/s, slips before, decimal logarithm."""
    numbers = (nstr(x, FEWER) for x in (event.duration, event.slip, event.peak_rate))
    return str(event.start_row), nstr(event.start_offset, MANY), *numbers, str(event.generation), nstr(event.growth, 4)


ALPHA_ONE = Table("slab_alpha_one.csv.gz", Slab(alpha=1.0), 100)
"""The slab of the paper's Fig. 6: 57 events, then a storm of micro-events."""
JUST_ABOVE_CRITICAL = Table("slab_just_above_critical.csv.gz", Slab(alpha=0.196001), 8_500)
"""The slab of Fig. 7, alpha_c + 1e-6 s/m: 8 215 micro-events of the first generation, then also some of the second."""


if __name__ == "__main__":
    for table in (ALPHA_ONE, JUST_ABOVE_CRITICAL):
        table.write()
