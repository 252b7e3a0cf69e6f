"""Content of an FMU file: XML, C sources, libraries, documentation and reference results; the zip archive."""

from __future__ import annotations

import uuid
import zipfile
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path

from ehlcontact.binaries import Platform, build_binaries
from ehlcontact.binaries.libraries import Progress
from fmu.documentation import documentation
from fmu.model_description import build_description, model_description, terminals
from fmu.references.files import reference_files
from fmu.references.series import References
from fmu.sources import CSRC, FMI_FILES, compiled, source_files
from fmu.spec import ModelSpec

ICON = Path(__file__).with_name("icon.png")  # 128 pixels square; FMI 3.0 asks for 100 at least

_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_URL, "https://pypi.org/project/ehlcontact/fmu")


def fmu_files(
    spec: ModelSpec,
    platforms: Sequence[Platform],
    fmi: int,
    progress: Progress | None = None,
    references: References | None = None,
) -> dict[str, bytes]:
    """All files of the FMU by path, compiled libraries included."""
    guid = content_guid(spec, fmi)
    code = source_files(spec, guid, fmi)
    units, interface = compiled(spec, fmi), FMI_FILES[fmi]
    files, labels = build_binaries(code, units, spec.identifier, platforms, fmi, progress)
    readme = (CSRC / "README.md").read_text(encoding="ascii")
    about = "" if references is None else references.about
    files["modelDescription.xml"] = model_description(spec, guid, fmi)
    files["documentation/index.html"] = documentation(spec, readme, "; ".join(labels), fmi, about).encode()
    brought = () if fmi == 2 else interface.standard
    files |= {f"sources/{name}": content for name, content in code.items() if name not in brought}
    if fmi == 3:
        files["sources/buildDescription.xml"] = build_description(spec.identifier, units)
        files["terminalsAndIcons/terminalsAndIcons.xml"] = terminals(spec)
    files["model.png" if fmi == 2 else "terminalsAndIcons/icon.png"] = ICON.read_bytes()
    for name in filter(None, ("license.txt", interface.licence)):
        files[f"documentation/licenses/{name}"] = (CSRC / "licenses" / name).read_bytes()
    return files | ({} if references is None else reference_files(references, spec))


def content_guid(spec: ModelSpec, fmi: int = 2) -> str:
    """GUID or token: a hash of model description and sources, equal for equal FMUs."""
    content = [model_description(spec, "", fmi), *source_files(spec, "", fmi).values()]
    return "{" + str(uuid.uuid5(_NAMESPACE, "\n".join(part.decode() for part in content))) + "}"


def pack(files: Mapping[str, bytes]) -> bytes:
    """Zip archive with sorted entries and fixed times: equal files give equal bytes."""
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whatever the machine, so that the mode below counts
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, files[name])
    return stream.getvalue()
