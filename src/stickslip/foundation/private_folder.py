"""Make or check a folder that no other user can change.

Compiled code is executed, so anyone who can write into its folder can run code as this user.
"""

from __future__ import annotations

import os
import shutil
import stat
from pathlib import Path

HAS_OWNERS = hasattr(os, "geteuid")
"""False on Windows, where access lists close the user's own folders to others."""
SUPERUSER = 0
"""User number of root, who may own the folders above."""
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
"""Mode bits that let other users write into a folder."""
OTHERS_ENTER = stat.S_IRWXG | stat.S_IRWXO
"""Mode bits that give other users any access to a folder."""


class NotPrivateError(OSError):
    """Report that another user can change a folder, or could have changed it; the message names the folder and the reason."""


def private_folder(path: Path) -> Path:
    """Make a folder that only this user can enter, or check an existing one, and return its path with links resolved.

    An existing folder of this user into which others could write is emptied. Raises NotPrivateError for a link, for a folder of
    another user, and for a folder that others can move away because they may write into one above it. Raises OSError if the folder
    cannot be made.
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
    if HAS_OWNERS and path.lstat().st_mode & OTHERS_ENTER:  # some file systems ignore modes
        raise NotPrivateError(f"{path} is open to other users")
    return path


def _check_above(folder: Path) -> None:
    """Raise NotPrivateError if another user can rename entries of a folder."""
    found = folder.lstat()
    if found.st_uid not in (os.geteuid(), SUPERUSER):
        raise NotPrivateError(f"{folder} belongs to another user")
    if found.st_mode & stat.S_ISVTX:  # sticky, like /tmp: only the owner of an entry can rename it
        return
    if found.st_mode & stat.S_IWOTH or (found.st_mode & stat.S_IWGRP and not _is_own_group(found.st_gid)):
        raise NotPrivateError(f"other users can write into {folder}")


def _is_own_group(group: int) -> bool:
    """Return True if a group has no member but this user; many systems give each user such a group and let it write."""
    import grp
    import pwd

    try:
        user, found = pwd.getpwuid(os.geteuid()), grp.getgrgid(group)
    except KeyError:
        return False
    return group == user.pw_gid and found.gr_name == user.pw_name and set(found.gr_mem) <= {user.pw_name}


def _check_existing(path: Path) -> None:
    """Close an existing folder to other users, and empty it first if they could write into it.

    Raises NotPrivateError if it is a link, not a folder, or owned by another user.
    """
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
