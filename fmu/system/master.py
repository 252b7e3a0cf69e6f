"""Master for system archives: all components step at once, or one after the other; through fmpy.

For checks: it does no more than any importer of such an archive. A single mass on one FMU:
``examples/studies/masters.py`` and ``coupling.py``.
"""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Collection, Mapping, Sequence
from contextlib import ExitStack, chdir
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.driver import Slave
from fmu.system.structure import SSD, SSV

_Floats = NDArray[np.float64]

DESCRIPTION = "SystemStructure.ssd"


class SystemRun:
    """The components of an archive, started; a context, which frees them.

    Parameters
    ----------
    content : bytes
        The archive.
    starts : mapping
        Values of inputs and states to start from, by component and name, beside those of the archive.
    serial : bool
        Whether components step one after the other, each with the new outputs of those before it.

    Raises
    ------
    InputError
        No archive with FMUs that this machine runs.
    """

    def __init__(
        self, content: bytes, starts: Mapping[str, Mapping[str, float]] | None = None, *, serial: bool = False
    ):
        self.messages: list[str] = []
        self.time, self.serial = 0.0, serial
        with ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="ehlcontact-system-"))
            try:
                with zipfile.ZipFile(io.BytesIO(content)) as archive:
                    archive.extractall(folder)
                root = ElementTree.parse(Path(folder, DESCRIPTION)).getroot()
                self._slaves = {
                    name: self._start(
                        stack, Path(folder), name, source, values | dict((starts or {}).get(name, {}))
                    )
                    for name, source, values in _components(root)
                }
            except (OSError, zipfile.BadZipFile, ElementTree.ParseError, KeyError) as error:
                raise InputError("path", str(error), f"an archive with {DESCRIPTION} and its FMUs") from None
            self._wires = _wires(root)
            self._stack = stack.pop_all()

    def _start(self, stack: ExitStack, folder: Path, name: str, source: str, values: dict[str, float]) -> Any:
        import fmpy

        place = folder / f"unpacked-{name}"
        fmpy.extract(str(folder / source), unzipdir=str(place))
        description = fmpy.read_model_description(str(place), validate=False)
        with chdir(Path.cwd()):  # fmpy leaves the process in another folder when a library does not load
            slave = Slave(str(place), description, self.messages)
        stack.callback(slave.free)
        slave.start(**values)
        return slave

    def __enter__(self) -> SystemRun:
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    def get(self, component: str, *names: str) -> list[float]:
        """Values of variables of a component."""
        return list(self._slaves[component].get(*names))

    def set(self, component: str, **values: float) -> None:
        """Set inputs that no wire sets."""
        self._slaves[component].set(**values)

    def step(self, h: float) -> None:
        """All components make a step [s], and outputs go to the inputs they are wired to."""
        for name, slave in self._slaves.items():
            slave.step(h)
            if self.serial:
                self._send([name])
        if not self.serial:
            self._send(self._slaves)
        self.time += h

    def _send(self, components: Collection[str]) -> None:
        """Outputs of these components to the inputs they are wired to."""
        sent = [(sink, self.get(*source)[0]) for source, sink in self._wires if source[0] in components]
        for (component, name), value in sent:
            self._slaves[component].set(**{name: value})

    def run(self, h: float, steps: int, watched: Sequence[tuple[str, str]]) -> _Floats:
        """Make steps; values of the watched variables (component, name), shape (steps + 1, watched)."""
        rows = [[self.get(*one)[0] for one in watched]]
        for _ in range(steps):
            self.step(h)
            rows.append([self.get(*one)[0] for one in watched])
        return np.array(rows)


def _components(root: ElementTree.Element) -> list[tuple[str, str, dict[str, float]]]:
    """Name, source and start values of each."""
    found = []
    for component in root.iter(f"{{{SSD}}}Component"):
        values = {
            parameter.attrib["name"]: float(parameter[0].attrib["value"])
            for parameter in component.iter(f"{{{SSV}}}Parameter")
        }
        found.append((component.attrib["name"], component.attrib["source"], values))
    return found


def _wires(root: ElementTree.Element) -> list[tuple[tuple[str, str], tuple[str, str]]]:
    ends = ("startElement", "startConnector", "endElement", "endConnector")
    rows = [[wire.attrib[end] for end in ends] for wire in root.iter(f"{{{SSD}}}Connection")]
    return [((a, b), (c, d)) for a, b, c, d in rows]
