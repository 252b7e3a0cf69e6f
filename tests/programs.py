"""The program and a Dask cluster in processes of their own; modules of scripts."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[1]


def command(*arguments):
    """The command line of the program with these arguments."""
    return [sys.executable, "-m", "ehlcontact.cli", *map(str, arguments)]


def environment(*paths, **more):
    """That of this process, with the packages of this folder and modules of `paths` before them."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (*paths, ROOT)))} | more


def program(*arguments, env=None, **options):
    """The finished process of the program; stdout and stderr as text, unless `options` redirect them."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": 300} | options
    return subprocess.run(command(*arguments), text=True, check=False, env=env or environment(), **streams)


def begin(*arguments, **options):
    """The running process of the program, its stderr as text; Ctrl-C interrupts it."""
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE} | options
    # a shell's background job passes on that it ignores Ctrl-C
    listen = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    return subprocess.Popen(command(*arguments), text=True, env=environment(), **streams, **listen)


def shell_script(file, text):
    """Path of a shell script that was written to a file."""
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(0o755)
    return str(file)


def script(path):
    """The module of a file outside of the packages, by its path from the root."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@contextmanager
def dask_cluster(folder, workers=2):
    """Address of a scheduler, and the processes of it and of its workers, ended at exit; files in `folder`."""
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment(ROOT / "tests")}
    file, processes = folder / "scheduler.json", []

    def start(module, *arguments):
        full = [sys.executable, "-m", f"distributed.cli.{module}", *map(str, arguments), "--no-dashboard"]
        processes.append(subprocess.Popen(full, **silent))

    try:
        start("dask_scheduler", "--port", 0, "--host", "127.0.0.1", "--scheduler-file", file)
        deadline = time.monotonic() + 60.0
        while not file.exists() or not file.read_text():
            assert processes[0].poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
        address = json.loads(file.read_text())["address"]
        for _ in range(workers):
            start("dask_worker", address, "--nthreads", 1, "--no-nanny", "--local-directory", folder)
        yield address, processes
    finally:
        for process in processes:
            process.kill()
            process.wait()
