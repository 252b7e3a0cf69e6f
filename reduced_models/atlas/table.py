"""What the atlas holds: solved points, their answers and how well these interpolate; and its file."""

from __future__ import annotations

import json
import zipfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.atlas.box import Box
from reduced_models.elements.film_response import FilterRates

_Floats = NDArray[np.float64]

SCHEMA, VERSION = "ehlcontact-atlas", 1


@dataclass(frozen=True, eq=False)
class AtlasTable:
    """Arrays over the n solved points, in the units of each point's own load."""

    points: _Floats  # (n, 3) M, L, kappa
    omega: _Floats  # (k,)
    approach: _Floats  # (n,)
    h_central: _Floats  # (n,)
    h_min: _Floats  # (n,)
    stiffness: _Floats  # (n, k) K(Omega)
    damping: _Floats  # (n, k) C(Omega)
    gains: _Floats  # (n, 3 + lags) of the film memory, over the damping at the lowest frequency > 0
    left_out: _Floats  # (n, 4 + 2 k) error at each point of an interpolation without it, see `atlas_surface`
    factor: _Floats  # (4 + 2 k,) from the errors of the nearest points to the error bar
    metadata: dict[str, Any]  # box, rates, command, version, sample, meshes, failures

    @property
    def box(self) -> Box:
        """Where the atlas answers."""
        return Box.from_dict(self.metadata["box"])

    @property
    def rates(self) -> FilterRates:
        """Of the film memory, the same at all points."""
        return FilterRates(**self.metadata["rates"])

    def save(self, path: Path) -> None:
        """Write as compressed npz, single precision but for the points; the same table makes the same bytes."""
        arrays = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "metadata"}
        small = {k: v if k in ("points", "omega") else v.astype(np.float32) for k, v in arrays.items()}
        header = json.dumps({"schema": SCHEMA, "schema_version": VERSION, **self.metadata}, sort_keys=True)
        try:
            with path.open("wb") as stream:
                np.savez_compressed(stream, metadata=np.array(header), **small)
        except OSError as error:
            raise InputError("atlas", str(path), f"a file that can be written ({error.strerror})") from None

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a table.

        Raises
        ------
        InputError
            Missing, damaged, no atlas, or one of a newer library.
        """
        try:
            with path.open("rb") as stream, np.load(stream) as file:
                metadata = json.loads(str(file["metadata"]))
                if metadata.get("schema") != SCHEMA:
                    raise InputError("atlas", str(path), f"a file with schema {SCHEMA!r}")
                if metadata.get("schema_version") != VERSION:
                    raise InputError("atlas", f"version {metadata.get('schema_version')}", f"of version {VERSION}")
                arrays = {f.name: file[f.name].astype(float) for f in fields(cls) if f.name != "metadata"}
        except OSError as error:
            raise InputError("atlas", str(path), f"a readable atlas ({error.strerror or error})") from None
        except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
            raise InputError("atlas", str(path), f"a complete atlas file ({error})") from None
        return cls(**arrays, metadata=metadata)
