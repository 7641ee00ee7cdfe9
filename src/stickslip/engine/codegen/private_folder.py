"""A folder that nobody else can change: compiled code is executed, so whoever can write into its folder runs code as this user."""

from __future__ import annotations

import os
import shutil
import stat
from pathlib import Path

HAS_OWNERS = hasattr(os, "geteuid")
"""False on Windows, where the user's own folders are closed to others by their access lists."""
SUPERUSER = 0
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
OTHERS_ENTER = stat.S_IRWXG | stat.S_IRWXO


class NotPrivateError(OSError):
    """A folder that somebody else can change, or could have: one line that says which and why."""


def private_folder(path: Path) -> Path:
    """Make a folder that only this user can enter, or check that it is one, and return its path without links.

    A folder of this user into which others could write is emptied. Raises NotPrivateError for a link, for a folder of another
    user, and for a folder that others can move away because they may write into one above it. Raises OSError where it cannot be
    made.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    above = path.parent.resolve()
    path = above / path.name
    if HAS_OWNERS:
        for folder in (above, *above.parents):
            _check_above(folder)
    try:
        path.mkdir(mode=0o700)
    except FileExistsError:
        _check_existing(path)
    if HAS_OWNERS and _mode(path) & OTHERS_ENTER:  # some file systems know no modes
        raise NotPrivateError(f"{path} is open to other users")
    return path


def _mode(path: Path) -> int:
    return stat.S_IMODE(path.lstat().st_mode)


def _check_above(folder: Path) -> None:
    """Raise NotPrivateError if another user can rename what is in a folder."""
    found = folder.lstat()
    if found.st_uid not in (os.geteuid(), SUPERUSER):
        raise NotPrivateError(f"{folder} belongs to another user")
    if found.st_mode & stat.S_ISVTX:  # as in /tmp: nobody renames what belongs to others
        return
    if found.st_mode & stat.S_IWOTH or (found.st_mode & stat.S_IWGRP and not _is_own_group(found.st_gid)):
        raise NotPrivateError(f"other users can write into {folder}")


def _is_own_group(group: int) -> bool:
    """Return True for a group of nobody but this user: many systems give each user one, and let it write by default."""
    import grp
    import pwd

    try:
        user, found = pwd.getpwuid(os.geteuid()), grp.getgrgid(group)
    except KeyError:
        return False
    return group == user.pw_gid and found.gr_name == user.pw_name and set(found.gr_mem) <= {user.pw_name}


def _check_existing(path: Path) -> None:
    """Close a folder of this user to others; empty it first if they could write into it. Raises NotPrivateError."""
    found = path.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise NotPrivateError(f"{path} is {'a link' if stat.S_ISLNK(found.st_mode) else 'not a folder'}")
    if not HAS_OWNERS:
        return
    if found.st_uid != os.geteuid():
        raise NotPrivateError(f"{path} belongs to another user")
    if found.st_mode & OTHERS_WRITE:
        shutil.rmtree(path)
        path.mkdir(mode=0o700)
    elif found.st_mode & OTHERS_ENTER:
        path.chmod(0o700)
