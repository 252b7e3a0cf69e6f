"""Worker process of `ehlcontact.executors.ProcessExecutor`.

Tasks arrive on stdin and answers leave on stdout, both pickled. What a task prints goes to stderr. SIGINT raises
`KeyboardInterrupt` in the task that runs. The process ends when its stdin is closed, also by the parent's death.
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import threading
from collections.abc import Callable
from typing import Any, BinaryIO

_channel: list[Callable[[str, Any], None]] = []  # of a worker, one to its parent


def report(value: Any) -> None:
    """Send a value, as progress, to the parent of this worker; without effect in any other process."""
    for send in _channel:
        send("report", value)


def serve() -> None:
    """Run tasks until stdin is closed."""
    tasks, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    lock = threading.Lock()

    def send(kind: str, value: Any) -> None:
        content = pickle.dumps((kind, value))
        with lock:
            answers.write(content)
            answers.flush()

    _channel.append(send)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a parent in the background may leave it ignored
    arrived: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(tasks, arrived), daemon=True).start()
    while True:
        try:
            function, args, kwargs = pickle.loads(arrived.get())
            kind, value = "result", function(*args, **kwargs)
        except BaseException as error:
            kind, value = "error", error
        try:
            send(kind, value)
        except (pickle.PicklingError, TypeError, AttributeError) as error:
            send("error", RuntimeError(f"{value!r} cannot be sent: {error}"))


def _receive(tasks: BinaryIO, arrived: queue.SimpleQueue[bytes]) -> None:
    """Pass tasks on; the end of the stream ends the process, whatever it is at."""
    try:
        while True:
            arrived.put(pickle.load(tasks))
    except (EOFError, OSError, pickle.UnpicklingError):
        os._exit(1)
