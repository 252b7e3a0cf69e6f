"""stdout and stderr that may be full, closed, or of few characters: told in one line, never run into."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO


class StdoutError(Exception):
    """stdout took no more; the message says why."""

    def __init__(self, error: OSError) -> None:
        self.closed = isinstance(error, BrokenPipeError)
        super().__init__(error.strerror or str(error))


class _Watched:
    """A stream whose failures are `StdoutError`: libraries for command lines take others for their own matter."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self.failure: StdoutError | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write what the encoding knows."""
        try:
            return self._stream.write(known(text, self._stream))
        except OSError as error:
            raise self._failure(error) from None

    def flush(self) -> None:
        """Write what is still held back."""
        try:
            self._stream.flush()
        except OSError as error:
            raise self._failure(error) from None

    def _failure(self, error: OSError) -> StdoutError:
        discard(self._stream)
        self.failure = self.failure or StdoutError(error)
        return self.failure


@contextmanager
def watched_stdout() -> Iterator[None]:
    """Within the block stdout raises `StdoutError`, also for what it still holds back at the end."""
    stream = sys.stdout
    if stream is None:  # closed before we were started: nobody wants to know
        yield
        return
    watched = _Watched(stream)
    sys.stdout = watched
    try:
        yield
        watched.flush()
        if watched.failure:  # swallowed by a library that only tried what kind of stream it is
            raise watched.failure
    finally:
        sys.stdout = stream


def to_stderr(line: str) -> None:
    """Write a line on stderr if anybody listens."""
    if sys.stderr is not None:
        try:
            sys.stderr.write(known(line, sys.stderr) + "\n")
            sys.stderr.flush()
        except OSError:
            discard(sys.stderr)


def known(text: str, stream: TextIO) -> str:
    """The text with the numbers of the characters that the stream's encoding does not know."""
    encoding = stream.encoding or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def discard(stream: TextIO) -> None:
    """Let what the stream still holds go nowhere: Python would try once more when it ends, and fail."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
