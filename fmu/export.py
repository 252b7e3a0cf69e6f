"""Element in, FMU file out."""

from __future__ import annotations

import os
import uuid
from pathlib import Path

from ehlcontact.errors import InputError
from ehlcontact.files import write_bytes
from fmu import build
from fmu.spec import Element, ModelSpec, contact_spec
from fmu.texts import config_header, documentation, model_description

_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_URL, "https://pypi.org/project/ehlcontact/fmu")
_FMI_HEADERS = ("fmi2FunctionTypes.h", "fmi2Functions.h", "fmi2TypesPlatform.h")
_LICENSES = ("license.txt", "fmi2-headers.txt")


def export_contact(
    element: Element, path: str | os.PathLike[str], *, fmi: int = 2, model_name: str | None = None
) -> Path:
    """Write a contact element as an FMU for co-simulation.

    Inputs `approach` and `rate`, output `force` with its tangents `stiffness` and `damping`, and
    `outside_validity`. K1, K2, K3, C1, low and high are tunable parameters that start at the element's
    values. Units are the element's: SI, or "1" for a dimensionless element. The same element, name, library
    version and compiler give the same bytes.

    Parameters
    ----------
    element : LinearContact or CubicContact
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
    files = {
        "modelDescription.xml": model_description(spec, guid),
        f"binaries/{folder}/{spec.identifier}.so": build.compile_library(sources, spec.sources, command),
        "documentation/index.html": page.encode(),
    }
    files |= {f"sources/{name}": content for name, content in sources.items()}
    for name in _LICENSES:
        files[f"documentation/licenses/{name}"] = (build.CSRC / "licenses" / name).read_bytes()
    return files


def source_files(spec: ModelSpec, guid: str) -> dict[str, bytes]:
    """Content of ``sources/``: all that a compiler needs."""
    files = {name: (build.CSRC / name).read_bytes() for name in (*spec.sources, *spec.headers, "README.md")}
    files |= {name: (build.CSRC / "fmi2" / name).read_bytes() for name in _FMI_HEADERS}
    files["config.h"] = config_header(spec, guid).encode("ascii")
    return files


def content_guid(spec: ModelSpec) -> str:
    """GUID that follows from the model description and the sources, so that equal FMUs have equal ones."""
    content = [model_description(spec, ""), *source_files(spec, "").values()]
    return "{" + str(uuid.uuid5(_NAMESPACE, "\n".join(part.decode() for part in content))) + "}"
