"""Figures of the packages: lines, modules, layers, circles of imports, constants, long functions; and a picture.

    python docs/module_map.py [CHECKOUT ...]               # a table, one column per checkout
    python docs/module_map.py --draw docs/images/module_map.png # the modules and their imports

Everything is read from the imports and definitions of the code; nothing of it is run. A module is a file or a
folder here; it is drawn one level above the highest that it imports.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

PACKAGES = ("ehlcontact", "reduced_models", "fmu")
LONG, MANY = 50, 8  # lines of a function without its docstring, arguments
Graph = dict[str, set[str]]


@cache
def tree(path: Path) -> ast.Module:
    """Syntax of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def modules(root: Path) -> dict[str, Path]:
    """Files of the library by dotted name; a package by its own."""
    found = {}
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def imports(root: Path) -> Graph:
    """Every file with the files it imports; names handed on by a package count as the package."""
    known = modules(root)
    graph: Graph = {name: set() for name in known}
    for name, path in known.items():
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                for alias in node.names:
                    whole = f"{node.module}.{alias.name}"
                    graph[name].add(whole if whole in known else node.module)
            elif isinstance(node, ast.Import):
                graph[name].update(alias.name for alias in node.names)
        graph[name] = {other for other in graph[name] if other in known and other != name}
    return graph


def entry_of(name: str, folder: str) -> str | None:
    """Entry of `folder` that holds the module, None outside it; the folder's own ``__init__`` is no module."""
    if not name.startswith(folder + "."):
        return None
    return name[len(folder) + 1 :].split(".", maxsplit=1)[0]


def imports_within(root: Path, folder: str) -> Graph:
    """The entries of a folder and which of them each imports."""
    graph: Graph = {}
    for name, others in imports(root).items():
        here = entry_of(name, folder)
        if here is None or here == "__main__":
            continue
        reached = {entry_of(other, folder) for other in others} - {None, here}
        graph.setdefault(here, set()).update(str(other) for other in reached)
    return graph


def circles(graph: Graph) -> list[set[str]]:
    """Groups that import each other in a loop."""
    reach = {name: _reached(graph, name) for name in graph}
    loops = {
        frozenset({other for other in reach[name] if name in reach[other]})
        for name in graph
        if name in reach[name]
    }
    return [set(loop) for loop in loops]


def _reached(graph: Graph, start: str) -> set[str]:
    seen: set[str] = set()
    todo = list(graph[start])
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += graph[name]
    return seen


def floors(graph: Graph) -> dict[str, int]:
    """Level of every module, from 1; modules of a circle share one."""
    loops = circles(graph)
    group = {name: next((min(loop) for loop in loops if name in loop), name) for name in graph}

    @cache
    def floor(name: str) -> int:
        members = [other for other in graph if group[other] == name]
        below = {group[other] for member in members for other in graph[member]} - {name}
        return 1 + max((floor(other) for other in below), default=0)

    return {name: floor(group[name]) for name in graph}


def functions(root: Path) -> Iterator[tuple[str, str, int, int]]:
    """Module, name, lines of code without the docstring, and arguments of every function."""
    for name, path in modules(root).items():
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                lines = body[-1].end_lineno - body[0].lineno + 1 if body else 0  # type: ignore[operator]
                a = node.args
                arguments = [
                    x.arg for x in (*a.posonlyargs, *a.args, *a.kwonlyargs) if x.arg not in ("self", "cls")
                ]
                yield name, node.name, lines, len(arguments)


def constants(root: Path) -> Iterator[tuple[str, str]]:
    """Module and name of every module-level number, or group of numbers, in capitals."""
    for name, path in modules(root).items():
        for node in tree(path).body:
            targets = (
                node.targets
                if isinstance(node, ast.Assign)
                else [node.target]
                if isinstance(node, ast.AnnAssign)
                else []
            )
            value = getattr(node, "value", None)
            for target in targets:
                for part in target.elts if isinstance(target, ast.Tuple) else [target]:
                    if (
                        isinstance(part, ast.Name)
                        and part.id.isupper()
                        and value is not None
                        and _is_number(value)
                    ):
                        yield name, part.id


def _is_number(node: ast.expr) -> bool:
    numbers = [n for n in ast.walk(node) if isinstance(n, ast.Constant)]
    return bool(numbers) and any(
        isinstance(n.value, int | float) and not isinstance(n.value, bool) for n in numbers
    )


def figures(root: Path) -> dict[str, str]:
    """The table of one checkout."""
    known = modules(root)
    lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in known.values())
    folders = [
        path for package in PACKAGES for path in [root / package, *(root / package).rglob("*")] if path.is_dir()
    ]
    fullest = {
        folder.relative_to(root).as_posix(): len([p for p in folder.iterdir() if p.name != "__pycache__"])
        for folder in folders
        if folder.name != "__pycache__"
    }
    busiest = max(fullest, key=lambda name: fullest[name])
    files = imports(root)
    table = {"library files (Python)": str(len(known)), "library lines (Python)": str(lines)}
    for package in PACKAGES:
        table[f"entries of {package}/"] = str(fullest[package])
    table["most entries of a folder"] = f"{fullest[busiest]} ({busiest})"
    for package in PACKAGES:
        graph = {k: v for k, v in imports_within(root, package).items() if k != "cli"}
        graph = {k: {other for other in v if other in graph} for k, v in graph.items()}
        table[f"levels, arrows of {package}/"] = f"{max(floors(graph).values())}, {sum(map(len, graph.values()))}"
    loops = circles(without_faces(files, known))
    for package in PACKAGES:
        loops += [loop for loop in circles(imports_within(root, package)) if len(loop) > 1]
    named = sorted({", ".join(sorted(name.rsplit(".", 1)[-1] for name in loop)) for loop in loops})
    table["circles of files or folders"] = "; ".join([str(len(named)), *named])
    table["constants (numbers in capitals)"] = str(len(set(constants(root))))
    found = list(functions(root))
    table[f"functions over {LONG} lines"] = str(sum(n > LONG for _, _, n, _ in found))
    table[f"functions of more than {MANY} arguments"] = str(sum(n > MANY for _, _, _, n in found))
    return table


def without_faces(graph: Graph, known: dict[str, Path]) -> Graph:
    """The graph without the packages' ``__init__``, which hand names on and so import all of their modules."""
    inner = {name for name, path in known.items() if path.stem != "__init__"}
    return {name: others & inner for name, others in graph.items() if name in inner}


SHEETS = (
    ("ehlcontact", "modules of one contact"),
    ("ehlcontact.solver", "solution of one film"),
    ("ehlcontact.transient", "transient film"),
    ("reduced_models", "elements, atlas, bearings, rotors"),
    ("reduced_models.elements", "contact elements"),
    ("ehlcontact.cli", "command line"),
)


def draw(root: Path, path: Path) -> None:
    """One sheet per folder: its modules on their levels, their lines, and an arrow to what each stands on."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, sheets = plt.subplots(3, 2, figsize=(13, 15.5), layout="constrained")
    for axes, (folder, title) in zip(sheets.ravel(), SHEETS, strict=True):
        graph = imports_within(root, folder)
        if folder == "ehlcontact":
            graph = {name: others - {"cli"} for name, others in graph.items() if name != "cli"}
        _draw_sheet(axes, graph, sizes(root, folder))
        axes.set_title(f"{folder}/ - {title}", loc="left", fontsize=11)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def sizes(root: Path, folder: str) -> dict[str, int]:
    """Lines of every module."""
    found: dict[str, int] = {}
    for name, path in modules(root).items():
        here = entry_of(name, folder)
        if here is not None:
            found[here] = found.get(here, 0) + len(path.read_text(encoding="utf-8").splitlines())
    return found


def _draw_sheet(axes: Any, graph: Graph, lines: dict[str, int]) -> None:
    levels = floors(graph)
    place: dict[str, tuple[float, float]] = {}
    for floor in sorted(set(levels.values())):
        row = sorted(name for name in graph if levels[name] == floor)
        # below the modules that it serves, as far as the width of the sheet allows
        for k, name in enumerate(row):
            place[name] = ((k + 0.5 + 0.12 * (floor % 3 - 1)) / len(row), float(floor))
    for name, others in graph.items():
        # an arrow that a way over other modules makes as well would only hide them
        through = set().union(*(_reached(graph, other) for other in others))
        for other in others - through:
            axes.annotate(
                "",
                xy=place[other],
                xytext=place[name],
                arrowprops={"arrowstyle": "-|>", "color": "#9aa7b5", "lw": 0.7, "shrinkA": 11, "shrinkB": 13},
            )
    for name, (x, y) in place.items():
        label = {"boxstyle": "round,pad=0.35", "fc": "#eef3f8", "ec": "#40566b", "lw": 0.9}
        axes.text(x, y, f"{name}\n{lines[name]}", ha="center", va="center", fontsize=8.5, bbox=label)
    axes.set(xlim=(-0.05, 1.05), ylim=(0.5, max(levels.values()) + 0.5), xticks=[])
    axes.set_yticks(range(1, max(levels.values()) + 1))
    axes.set_ylabel("layer")
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)


def main() -> None:
    """Print the table, or draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkouts", nargs="*", type=Path, default=[Path(__file__).parents[1]])
    parser.add_argument("--draw", type=Path, metavar="PNG", help="draw the last checkout instead")
    parser.add_argument("--list", action="store_true", help="name the long functions and those of many arguments")
    arguments = parser.parse_args()
    if arguments.draw is not None:
        draw(arguments.checkouts[-1].resolve(), arguments.draw)
        return
    tables = [figures(root.resolve()) for root in arguments.checkouts]
    print("| | " + " | ".join(str(root) for root in arguments.checkouts) + " |")
    print("|---|" + "---|" * len(tables))
    for key in tables[0]:
        print(f"| {key} | " + " | ".join(table[key] for table in tables) + " |")
    if arguments.list:
        for module, name, lines, many in functions(arguments.checkouts[-1].resolve()):
            if lines > LONG or many > MANY:
                print(f"{module}.{name}: {lines} lines, {many} arguments")


if __name__ == "__main__":
    main()
