"""A walk through the posterior distribution that is kept in a file: one that was killed goes on where it was, bit for bit."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.foundation import netcdf_file
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import check_replaceable
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import Variable

FORMAT_OF_WALK = 1
"""Version of the layout of the file."""
EVERY = 30.0
"""Time (s of wall clock) between two checkpoints."""
SHARE_OF_WRITING = 0.1
"""Largest share of the time that writing them may take."""
GENERATOR = "MT19937"
"""The generator of random numbers of emcee."""


@dataclass
class KeptWalk:
    """The file of a walk, or no file. A walk is known by `digest`, a hash of all that decides its steps."""

    path: Path | None
    digest: str = ""
    due: float = field(default_factory=lambda: time.monotonic() + EVERY)

    def of(self, *decides: Any) -> KeptWalk:
        """Return the file for a walk, given the arrays, numbers and texts that decide its steps."""
        digest = hashlib.sha256()
        for one in decides:
            array = np.ascontiguousarray(one)
            digest.update(f"{array.dtype.str}{array.shape}".encode() + array.tobytes())
        return KeptWalk(self.path, digest.hexdigest())

    def read(self, shape: tuple[int, ...], state: Callable[..., Any]) -> tuple[Floats, Any] | None:
        """Return the steps of the walk so far and its state after the last, or None if it has not begun.

        `shape` is that of a whole walk; `state` makes a state of emcee. Raises InputError if the file holds another walk.
        """
        if self.path is None or not self.path.exists():
            return None
        found = netcdf_file.read(self.path, "the checkpoint of a walk")
        if found.attrs.get("walk") != FORMAT_OF_WALK or found.attrs.get("digest") != self.digest:
            raise InputError(f"infer: checkpoint {self.path}: is of another inference: choose another name, or remove it")
        steps = found["steps"].to_numpy()
        wrong = steps.shape[1:] != shape[1:] or not 0 < len(steps) <= shape[0] or not np.isfinite(steps).all()
        if wrong or found["probability"].shape != shape[1:2] or found["key"].shape != (624,):
            raise InputError(f"infer: checkpoint {self.path}: damaged: choose another name, or remove it")
        about = found.attrs
        key = found["key"].to_numpy().astype(np.uint32)
        random = (GENERATOR, key, int(about["place"]), int(about["has_normal"]), float(about["normal"]))
        return steps, state(steps[-1].copy(), log_prob=found["probability"].to_numpy(), random_state=random)

    def check(self) -> None:
        """Refuse the name of a file that something else has written, or that could not be written. Raises InputError."""
        if self.path is None:
            return
        if self.path.suffix.lower() != ".nc":
            raise InputError(f"infer: checkpoint {self.path}: the name must end in .nc")
        if not self.path.absolute().parent.is_dir():
            raise InputError(f"infer: checkpoint {self.path}: there is no folder {self.path.parent}")
        check_replaceable(self.path, f"infer: checkpoint {self.path}")

    def save(self, steps: Floats, state: Any, *, now: bool = False) -> None:
        """Write the steps so far and the state after the last, if it is time to or `now`."""
        begun = time.monotonic()
        if self.path is None or not len(steps) or not (now or begun >= self.due):
            return
        name, key, place, has_normal, normal = state.random_state
        assert name == GENERATOR
        arrays = {
            "steps": Variable(("step", "walker", "number"), steps),
            "probability": Variable(("walker",), np.asarray(state.log_prob, float)),
            "key": Variable(("word",), np.asarray(key, np.int64)),
        }
        about = {"source": "stickslip", "walk": FORMAT_OF_WALK, "digest": self.digest, "place": int(place)}
        about |= {"has_normal": int(has_normal), "normal": float(normal)}
        netcdf_file.write_variables(arrays, about, self.path)
        ended = time.monotonic()
        self.due = ended + max(EVERY, (ended - begun) / SHARE_OF_WRITING)


NOT_KEPT = KeptWalk(None)
"""A walk without a file."""
