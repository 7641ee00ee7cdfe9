"""How much memory is free: of the machine, of the control groups of this process (containers, batch jobs), and of its limits.

A process that takes more is not told so: the kernel ends it, and what it has computed is lost.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from stickslip.foundation.errors import InputError

SETTING = "STICKSLIP_MEMORY"
"""Environment variable with the memory to count on, such as "8 GB", in place of what is free."""
SHARE_OF_MEMORY = 1.0 / 6.0
"""Largest share of the free memory that a result may take: its summary and its file take up to four times as much, for a moment."""
SMALL = 64e6
"""Size (bytes) up to which nobody looks for free memory, which takes half a millisecond."""
BYTES_OF_UNITS = {"": 1.0, "B": 1.0, "kB": 1e3, "KB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
BYTES_OF_UNITS |= {"KiB": 2.0**10, "MiB": 2.0**20, "GiB": 2.0**30, "TiB": 2.0**40}
"""Bytes of each unit of a size."""
GROUPS = Path("/sys/fs/cgroup")
"""Where Linux shows control groups."""
OWN_GROUPS = Path("/proc/self/cgroup")
"""Where it says to which of them this process belongs."""
FILES = {
    "": ("memory.max", "memory.current", "inactive_file"),
    "memory": ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}
"""Files of a control group with its limit and its use (bytes), and what counts as use there although it is given back when memory
is short: of the second version, and of the first, where memory has a folder of its own."""


def granted(wanted: float, taken: float) -> float:
    """Return how much memory a result may take (bytes): what is wanted, or a share of what is free and of what it has taken so far.

    Raises InputError as `chosen_memory` does.
    """
    chosen = chosen_memory()
    if chosen is not None:
        return min(wanted, SHARE_OF_MEMORY * chosen)
    return wanted if wanted <= SMALL else min(wanted, SHARE_OF_MEMORY * (free_memory() + taken))


def chosen_memory() -> float | None:
    """Return the memory to count on that the environment variable STICKSLIP_MEMORY names (bytes), or None if it is not set.

    Raises InputError if that is no size.
    """
    text = os.environ.get(SETTING)
    return size_of(text) if text else None


def free_memory() -> float:
    """Return the number of bytes that this process may still take, or infinity if nothing is known about it."""
    return max(0.0, min((*_of_system(), *_of_groups(), *_of_limits()), default=math.inf))


def size_of(text: str) -> float:
    """Return a size in bytes from a text such as "8 GB". Raises InputError for any other text."""
    found = re.fullmatch(r"\s*([0-9]{1,20}(?:\.[0-9]{1,20})?)\s*([A-Za-z]*)\s*", text)
    if found is None or found[2] not in BYTES_OF_UNITS or float(found[1]) == 0.0:
        raise InputError(f"{SETTING}: {ascii(text)[:60]} is not a size of memory; write it like 8 GB")
    return float(found[1]) * BYTES_OF_UNITS[found[2]]


def _of_system() -> Iterator[float]:
    """Yield what the machine has left, as far as the operating system tells."""
    with suppress(OSError, ValueError):
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                yield 1024.0 * int(line.split()[1])
                return
    with suppress(OSError, ValueError, AttributeError):  # not Linux: half of what there is may be taken
        yield 0.5 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def _of_groups() -> Iterator[float]:
    """Yield what each control group above this process has left, where it has a limit."""
    with suppress(OSError):
        for line in OWN_GROUPS.read_text().splitlines():
            _, kinds, place = line.split(":", 2)
            kind = "memory" if "memory" in kinds.split(",") else ""
            if kinds and not kind:
                continue
            root = GROUPS / kind
            inside = root / place.lstrip("/")
            folders = [inside, *inside.parents]
            for folder in folders[: folders.index(root) + 1] if root in folders else [root]:
                yield from _left_in(folder, *FILES[kind])


def _left_in(group: Path, limit: str, use: str, given_back: str) -> Iterator[float]:
    """Yield what the folder of a control group says that it has left; nothing if it has no limit, or is not shown here."""
    with suppress(OSError, ValueError):  # a limit may also be the word "max"
        left = float(int((group / limit).read_text()) - int((group / use).read_text()))
        stat = dict(line.split() for line in (group / "memory.stat").read_text().splitlines())
        yield left + int(stat.get(given_back, 0))


def _of_limits() -> Iterator[float]:
    """Yield what the limits of this process (`ulimit -v` and `-d`) leave."""
    with suppress(ImportError, OSError, ValueError, IndexError):
        import resource  # not on Windows

        pages = [int(one) for one in Path("/proc/self/statm").read_text().split()]
        for limit, used in ((resource.RLIMIT_AS, pages[0]), (resource.RLIMIT_DATA, pages[5])):
            most, _ = resource.getrlimit(limit)
            if most != resource.RLIM_INFINITY:
                yield float(most - used * resource.getpagesize())
