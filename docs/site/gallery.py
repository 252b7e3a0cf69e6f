"""The pictures of the examples in the gallery, each drawn by the example's own `main`.

    python docs/site/gallery.py [NAME ...]   # all of them, or these; minutes, for the atlas on a cluster

An example whose extra is not installed is left out, and said.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXAMPLES, PICTURES = ROOT / "examples", ROOT / "docs" / "images" / "examples"


def draw(name: str) -> Path:
    """Run one example; its picture."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    if spec is None or spec.loader is None or not (EXAMPLES / f"{name}.py").is_file():
        raise SystemExit(f"{name}: no such example")
    sys.path.insert(0, str(EXAMPLES))  # one may use another
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    PICTURES.mkdir(exist_ok=True)
    target = PICTURES / f"{name}.png"
    module.main(str(target))
    return target


def main() -> None:
    """All, or those named."""
    for name in sys.argv[1:] or sorted(path.stem for path in EXAMPLES.glob("*.py")):
        try:
            print(draw(name).relative_to(ROOT))
        except ModuleNotFoundError as error:
            print(f"{name}: left out, {error.name} is not installed")


if __name__ == "__main__":  # an example may start processes, which import this file again
    main()
