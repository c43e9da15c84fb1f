"""Files that are written whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

OTHER = {
    stat.S_IFDIR: "a directory",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFLNK: "a link that leads to itself",
}
"""What is no file that could be replaced, by its type."""
LONGEST_SUFFIX = 8


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside `path` that takes its place when the block ends well.

    Links are followed, permissions and owner kept; of a file with several names this one gets the
    new content. What cannot be written says so by the name that was given.
    """
    draft = None
    try:
        target = Path(os.path.realpath(path))
        there = _there(target)
        draft = _beside(target)
        yield draft
        _finish(draft, there)
        draft.replace(target)
    except OSError as error:
        own = draft is None or error.filename in (None, str(draft))
        if own and error.errno is not None:
            error.filename, error.filename2 = os.fspath(path), None
        raise
    finally:
        if draft is not None:
            draft.unlink(missing_ok=True)


def write_bytes(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file whole or not at all."""
    with replacing(path) as draft:
        draft.write_bytes(content)


def _there(target: Path) -> os.stat_result | None:
    """Return what is there; refuse what is no file and what is read-only."""
    try:
        there = target.lstat()
    except FileNotFoundError:
        return None
    kind = stat.S_IFMT(there.st_mode)
    if kind != stat.S_IFREG:
        number = errno.EISDIR if kind == stat.S_IFDIR else errno.EINVAL
        raise OSError(number, f"path must be a file or a new name, not {OTHER[kind]}")
    if not os.access(target, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))
    return there


def _beside(target: Path) -> Path:
    """Make an empty file in the same folder, of a name that no file system finds too long."""
    import tempfile

    # writers of figures go by the suffix
    suffix = target.suffix if len(target.suffix) <= LONGEST_SUFFIX else ""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=".rd-", suffix=suffix)
    os.close(handle)
    return Path(name)


def _finish(draft: Path, there: os.stat_result | None) -> None:
    """Wait until the disk has it all, some tell only then that they are full; keep what was set."""
    handle = os.open(draft, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
    if there is not None:
        with suppress(OSError):  # another's file, unless it is root who writes
            os.chown(draft, there.st_uid, there.st_gid)
    draft.chmod(0o666 & ~_umask() if there is None else stat.S_IMODE(there.st_mode))


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
