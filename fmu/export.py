"""Element in, FMU file out."""

from __future__ import annotations

import os
import uuid
from pathlib import Path

from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from fmu import build
from fmu.c_headers import c_headers
from fmu.contacts import Element, contact_spec
from fmu.glue import GLUE
from fmu.spec import ModelSpec
from fmu.texts import documentation, model_description

_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_URL, "https://pypi.org/project/ehlcontact/fmu")
_LICENSES = ("license.txt", "fmi2-headers.txt")


def export_contact(
    element: Element, path: str | os.PathLike[str], *, fmi: int = 2, model_name: str | None = None
) -> Path:
    """Write a contact element as an FMU for co-simulation and model exchange.

    Inputs `approach` and `rate`, output `force` with its tangents `stiffness` and `damping`, and
    `outside_validity` with the bound that is left. Coefficients of elements without memory, and their interval,
    are tunable parameters that start at the element's values; those of a film memory are constants, for others
    could put energy into a vibration. The fixed parameter `input_meaning` says what the inputs of a
    co-simulation step are: extrapolated (1, the default), those of its end (2), or held (3). Units are the
    element's: SI, or "1" for a dimensionless element. The same element, name, library version and compiler give
    the same bytes.

    Parameters
    ----------
    element : ContactElement
        Of any kind.
    path : path-like
        File to write, ending in ``.fmu``; an existing one is replaced in one move.
    fmi : int
        FMI version; only 2 is built yet.
    model_name : str, optional
        Name of the model; the class of the element by default.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Another kind of element or FMI version, a name that is not printable, a file that cannot be written.
    BuildError
        No C compiler, or one that failed.
    """
    if isinstance(fmi, bool) or fmi != 2:
        raise InputError("fmi", fmi, "2 (FMI 3 is not built yet)")
    target = Path(path)
    if target.suffix.lower() != ".fmu":
        raise InputError("path", str(path), "a file name ending in .fmu")
    spec = contact_spec(element, model_name)
    if not target.parent.is_dir():  # before compiling
        raise InputError("path", str(path), "in a folder that exists")
    return write_bytes(target, build.pack(fmu_files(spec)))


def fmu_files(spec: ModelSpec) -> dict[str, bytes]:
    """Everything in the FMU by its path, the compiled binary included."""
    guid = content_guid(spec)
    sources = source_files(spec, guid)
    command = build.find_compiler()
    folder = build.binary_folder()
    readme = (build.CSRC / "README.md").read_text(encoding="ascii")
    page = documentation(spec, readme, build.compiler_label(command))
    units = (*GLUE[2].sources, *spec.sources)
    files = {
        "modelDescription.xml": model_description(spec, guid),
        f"binaries/{folder}/{spec.identifier}.so": build.compile_library(sources, units, command),
        "documentation/index.html": page.encode(),
    }
    files |= {f"sources/{name}": content for name, content in sources.items()}
    for name in _LICENSES:
        files[f"documentation/licenses/{name}"] = (build.CSRC / "licenses" / name).read_bytes()
    return files


def source_files(spec: ModelSpec, guid: str) -> dict[str, bytes]:
    """Content of ``sources/``: all that a compiler needs."""
    glue = GLUE[2]
    names = (*glue.sources, *spec.sources, *glue.headers, *spec.headers, "README.md")
    found = {path.name: path for path in build.CSRC.rglob("*") if path.is_file()}
    files = {name: found[name].read_bytes() for name in (*names, *glue.standard)}
    return files | {name: text.encode("ascii") for name, text in c_headers(spec, guid).items()}


def content_guid(spec: ModelSpec) -> str:
    """GUID that follows from the model description and the sources, so that equal FMUs have equal ones."""
    content = [model_description(spec, ""), *source_files(spec, "").values()]
    return "{" + str(uuid.uuid5(_NAMESPACE, "\n".join(part.decode() for part in content))) + "}"
