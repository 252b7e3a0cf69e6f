"""An FMU file, opened: unpacked into a temporary folder, with its model description and instances of it."""

from __future__ import annotations

import re
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehlcontact.errors import InputError
from ehlcontact.files import is_file, require_no_pipe
from fmu.driver import Exchange, Slave

LARGEST_UNPACKED = 2**29  # bytes: ours, with the libraries of all platforms, have some MB
C_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


@dataclass(frozen=True, slots=True)
class FmuFile:
    """An FMU as long as `opened` holds it.

    Attributes
    ----------
    path : Path
        The archive.
    folder : str
        Where it is unpacked.
    description : fmpy.model_description.ModelDescription
    """

    path: Path
    folder: str
    description: Any

    @contextmanager
    def running(self) -> Iterator[tuple[Any, Any]]:
        """Instances for co-simulation and model exchange (None without the interface), freed at the end."""
        made: list[Any] = []
        messages: list[str] = []
        try:
            with chdir(Path.cwd()):  # fmpy leaves the process in another folder when a library does not load
                for kind in (Slave, Exchange):
                    there = getattr(self.description, kind.section) is not None
                    made.append(kind(self.folder, self.description, messages, loggingOn=True) if there else None)
        except Exception as error:  # fmpy raises bare Exception among others
            _free(made)
            reason = " ".join([str(error), *messages])
            raise InputError("path", str(self.path), f"an FMU that can be instantiated ({reason})") from None
        try:
            yield made[0], made[1]
        finally:
            _free(made)


def _free(made: list[Any]) -> None:
    for instance in filter(None, made):
        instance.free()


@contextmanager
def opened(file: Path) -> Iterator[FmuFile]:
    """Unpack an FMU into a temporary folder and read its model description.

    Raises
    ------
    InputError
        Not a readable FMU for this platform.
    """
    try:
        require_no_pipe(file)
        if file.exists() and not is_file(file) and not file.is_dir():
            raise ValueError("a device, in place of a file")
        with zipfile.ZipFile(file) as archive:
            names, size = set(archive.namelist()), sum(one.file_size for one in archive.infolist())
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise InputError("path", str(file), f"a readable FMU ({' '.join(str(error).split())})") from None
    if "modelDescription.xml" not in names:
        system = "SystemStructure.ssd" in names
        reason = "a system archive, with FMUs in its resources/" if system else "no modelDescription.xml in it"
        raise InputError("path", str(file), f"a readable FMU ({reason})")
    if size > LARGEST_UNPACKED:  # more than it says, no archive unpacks to
        allowed = f"an FMU that unpacks to at most {LARGEST_UNPACKED >> 20} MiB, not {size >> 20} MiB"
        raise InputError("path", str(file), allowed)
    import fmpy

    folder = tempfile.mkdtemp(prefix="ehlcontact-verify-")
    try:
        try:
            fmpy.extract(str(file), unzipdir=folder)
            description = fmpy.read_model_description(folder, validate=False)
        except Exception as error:  # fmpy raises bare Exception among others
            reason = " ".join(str(error).split()) or type(error).__name__
            if isinstance(error, AttributeError | TypeError):  # of what fmpy misses in the XML
                reason = "modelDescription.xml lacks parts that every FMU has"
            raise InputError("path", str(file), f"a readable FMU ({reason})") from None
        for interface in filter(None, (description.coSimulation, description.modelExchange)):
            name = interface.modelIdentifier or ""
            if not C_NAME.fullmatch(name):  # a path, say, to a library outside
                allowed = f"an FMU whose modelIdentifier is a C name, not {name[:60]!r}"
                raise InputError("path", str(file), allowed)
        # not fmpy.supported_platforms, which lacks Linux on arm
        there = {path.name for path in Path(folder, "binaries").glob("*")}
        if description.coSimulation is None or not {fmpy.platform, fmpy.platform_tuple} & there:
            raise InputError("path", str(file), f"an FMU for co-simulation on {fmpy.platform}")
        yield FmuFile(file, folder, description)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
