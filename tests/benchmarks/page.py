"""The tables of docs/notes/solver_development.md, remade from the JSON files of the benchmarks.

    python tests/benchmarks/page.py run.json cycles.json box-7.json box-11.json

Files of `run`, `cycles` and `box`, in any order and number; where rows of the same name are in several files of a
tool, the last one counts. A table for which there is no file stays as it is. The tables stand in the page between
``<!-- NAME, made by page.py -->`` and ``<!-- end of NAME -->``.
"""

from __future__ import annotations

import argparse
import json
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
from row_file import Row

PAGE = Path(__file__).parents[2] / "docs" / "notes" / "solver_development.md"

Rows = dict[str, Row]

# Venner and Lubrecht's published program, seconds to accuracy against its own converged solution, one
# thread: with its published under-relaxation factors, and with factors tuned; measured by the author of issue 11
# side by side with this library, on a machine whose conv is about 4 ms. By intervals, M and oil.
PUBLISHED = {
    (256, 20, "roelands"): (3.1, 0.94),
    (256, 200, "roelands"): (3.1, 1.1),
    (256, 20, "barus"): (2.7, 0.84),
    (256, 200, "barus"): (2.2, 0.94),
    (512, 20, "roelands"): (10.5, 3.2),
    (512, 200, "roelands"): (11.4, 3.6),
    (512, 20, "barus"): (8.4, 9.5),
    (512, 200, "barus"): (7.8, 4.2),
}
PUBLISHED_CONV = 4e-3  # s, of the machine of those figures
REACHED = "accurate", "full"
COSTS = ["accurate", "to 1e-8", "accurate, two threads", "to 1e-8, two threads"]
NAMES = {"roelands": "Roelands, compressible", "barus": "Barus, incompressible"}


def number(value: float | None, digits: int = 2) -> str:
    """A few digits without exponent where that is short; a dash for none."""
    if value is None:
        return "-"
    rounded = float(f"{value:.{digits}g}")
    if not 1e-3 <= abs(rounded) < 1e5:
        return f"{value:.{digits - 1}e}"
    return f"{rounded:.0f}" if abs(rounded) >= 100.0 else f"{value:#.{digits}g}".rstrip(".")


def table(head: list[str], rows: list[list[str]]) -> str:
    """As markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def made_table(head: list[str], cells: list[list[str]], rows: list[Row]) -> str | None:
    """The table and what its rows were made by; nothing without rows."""
    return table(head, cells) + "\n\n" + made_by(rows) if rows else None


def point_name(row: Row) -> str:
    """M, L, kappa, and the oil where it is not the default one."""
    oil = "" if row.get("viscosity", "roelands") == "roelands" else f", {NAMES[row['viscosity']]}"
    return f"{row['M']:g}, {row['L']:g}, {row['kappa']:g}{oil}"


def made_by(rows: list[Row]) -> str:
    """Dates, versions and conv of these rows."""
    dates = sorted({row["date"] for row in rows})
    commits = sorted({row["commit"] for row in rows})
    conv = [value for row in rows for value in row.get("conv_ms", ())]
    refused = sum(bool(row.get("refused")) for row in rows)
    told = f"{' to '.join(sorted({dates[0], dates[-1]}))}, version {', '.join(commits)}"
    if conv:
        told += f", conv {min(conv):.1f} to {max(conv):.1f} ms"
    return told + (f", {refused} without ratio because the machine was busy" if refused else "") + "."


def reached(part: Row | None) -> str:
    """Cycles, and conv."""
    return "-" if part is None else f"{part['cycles']}: {ratio(part)}"


def ratio(part: Row) -> str:
    """Conv; that of processor time where the wall's would tell how busy the machine was."""
    if part.get("conv") is None and part.get("cpu_conv") is not None:
        return f"({number(part['cpu_conv'], 3)} cpu)"
    return number(part.get("conv"), 3)


def shared_ratio(row: Row, name: str) -> str:
    """Conv with more threads, and how many times faster that is than with one."""
    shared = row.get(f"{name}_shared")
    if not shared or shared.get("conv") is None:
        return "-"
    return f"{ratio(shared)} ({number(row[name]['seconds'] / shared['seconds'], 3)})"


def steady(rows: Rows) -> str | None:
    """Steady films: cost to accuracy and to full convergence, and of `solve_steady` at its own tolerance."""
    mine = [row for key, row in rows.items() if key.startswith("steady ")]
    films = list(dict.fromkeys(key.rsplit(" ", 1)[0] for key in rows))
    cells = []
    for row in sorted(mine, key=lambda row: (films.index(row["key"].rsplit(" ", 1)[0]), row.get("n", 0))):
        if "n" not in row:
            continue
        told = "" if row["verdict"] == "converges" else row["verdict"]
        factor = number(row["factor_v21"]) if row["factor"] else told
        asked = by_default(row.get("solve_steady"))
        cells.append([point_name(row), f"{row['n']}", *costs(row), factor, asked, number(row["peak_mb"], 3)])
    head = ["M, L, kappa", "n", *COSTS, "factor per V(2,1)", "`solve_steady`, its own tol", "MB"]
    return made_table(head, cells, mine)


def steps(rows: Rows) -> str | None:
    """Steps in time, likewise."""
    mine = [row for key, row in rows.items() if key.startswith("step ")]
    cells = []
    for row in sorted(mine, key=lambda row: (row["motion"], row["n"])):
        told = "" if row["verdict"] == "converges" else f" ({row['verdict']})"
        accurate, full, *shared = costs(row)
        asked = by_default(row.get("simulate"))
        cells.append([row["motion"], f"{row['n']}", accurate, full + told, *shared, asked])
    return made_table(["motion", "n", *COSTS, "`simulate`, its own tol"], cells, mine)


def costs(row: Row) -> list[str]:
    """Cells of `COSTS`."""
    one = [reached(row[name]) for name in REACHED]
    return one + [shared_ratio(row, name) for name in REACHED]


def by_default(part: Row | None) -> str:
    """Cost at the library's own tolerance, with its status and whether the result is accurate."""
    if not part:
        return "-"
    fits = {True: "", False: ", not accurate", None: ", accuracy unknown"}[part["accurate"]]
    return f"{part['status']}{fits}, {reached(part)}"


def others(rows: Rows) -> str | None:
    """The rest of `run`."""
    mine = [row for key, row in rows.items() if not key.startswith(("steady ", "step "))]
    return made_table(["work", "conv"], [[row["key"], ratio(row)] for row in mine], mine)


def published(rows: Rows) -> str | None:
    """Beside the published program."""
    cells, mine = [], []
    for (n, M, oil), (as_published, tuned) in PUBLISHED.items():
        name = f"steady {M}-10-1{'-barus' if oil == 'barus' else ''} {n}"
        row = rows.get(name)
        ours = ["-", "-"]
        if row is not None:
            mine.append(row)
            part = row["accurate"]
            ours = [ratio(part), number(part["seconds"])] if part else [row["verdict"], "-"]
        theirs = [number(s / PUBLISHED_CONV, 3) for s in (as_published, tuned)]
        cells.append([f"{n + 1}^2", f"{M}", NAMES[oil], *theirs, *ours])
    head = ["grid", "M", "oil", "published factors, conv", "tuned, conv", "ours, conv", "ours, s"]
    return made_table(head, cells, mine)


def cycles(rows: Rows) -> str | None:
    """24 points: cycles to 1e-8 and mean factor per V(2,1)."""
    if not rows:
        return None
    grids = sorted({row["n"] for row in rows.values() if "n" in row})
    names = dict.fromkeys(key.rsplit(" ", 1)[0] for key in rows)
    cells = []
    for name in names:
        known = [rows.get(f"{name} {n}") for n in grids]
        cells.append([name.replace(":", ", "), *(_cycles_cell(row) for row in known)])
    text = table(["M, L, kappa", *(f"n = {n}" for n in grids)], cells)
    full = [row for row in rows.values() if row.get("full")]
    most = max((row["full"]["cycles"] for row in full), default=0)
    worst = max((row["factor_v21"] for row in full if row["factor_v21"]), default=None)
    told = f"{len(full)} of {len(rows)} reach 1e-8, in at most {most} cycles; worst factor {number(worst)}."
    return f"{text}\n\n{told} {made_by([row for row in rows.values() if 'date' in row])}"


def _cycles_cell(row: Row | None) -> str:
    if row is None:
        return ""
    if not row.get("full"):
        return str(row["verdict"])
    return f"{row['full']['cycles']}, {number(row['factor_v21'])}"


def box(files: dict[int, Rows], made: list[Row]) -> str | None:
    """The box, one line for each seed."""
    if not files:
        return None
    cells = []
    for seed, rows in sorted(files.items()):
        found = [row for key, row in rows.items() if not key.startswith("thin ")]
        thin = [row for key, row in rows.items() if key.startswith("thin ") and row["move"] is not None]
        counts = Counter(row["status"] for row in found)
        good = counts.pop("converged", 0)
        failed = ", ".join(f"{n} `{status}`" for status, n in counts.most_common()) or "none"
        seconds = [row["seconds"] for row in found if "seconds" in row]
        moves = [row["move"] for row in thin]
        moved = f"{sum(move > 0.1 for move in moves)} of {len(moves)}, worst {max(moves):.1%}" if moves else "-"
        time = f"{np.median(seconds):.2f} s / {sum(seconds) / 60.0:.1f} min"
        cells.append([f"{seed}", f"{len(found)}", f"{good} ({good / len(found):.1%})", failed, time, moved])
    head = ["seed", "points", "converged", "others", "time, median / all", "smallest film moves by more than 10 %"]
    return table(head, cells) + "\n\n" + made_by(made)


def replaced(page: str, name: str, text: str) -> str:
    """The page with another table."""
    start, end = f"<!-- {name}, made by page.py -->\n", f"<!-- end of {name} -->"
    pattern = re.compile(re.escape(start) + ".*?" + re.escape(end), flags=re.S)
    if not pattern.search(page):
        raise SystemExit(f"{PAGE}: has no place for the table of {name}")
    return pattern.sub(lambda _: f"{start}{text}\n{end}", page)


def remade(page: str, files: list[Row]) -> tuple[str, list[str]]:
    """The page with all tables that these files know, and the names of the others."""
    by_tool: dict[str, Rows] = {"run.py": {}, "cycles.py": {}}
    boxes: dict[int, Rows] = {}
    made: list[Row] = []
    for file in files:
        rows = {row["key"]: row for row in file["rows"]}
        if file["tool"] == "box.py":
            boxes.setdefault(file["settings"]["seed"], {}).update(rows)
            made.append(file["made"])
        else:
            by_tool[file["tool"]].update(rows)
    run = by_tool["run.py"]
    tables: dict[str, Callable[[], str | None]] = {
        "steady": lambda: steady(run),
        "steps": lambda: steps(run),
        "others": lambda: others(run),
        "published": lambda: published(run),
        "cycles": lambda: cycles(by_tool["cycles.py"]),
        "box": lambda: box(boxes, made),
    }
    left = []
    for name, make in tables.items():
        text = make()
        if text is None:
            left.append(name)
        else:
            page = replaced(page, name, text)
    return page, left


def main() -> None:
    """Remake the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    files = [json.loads(path.read_text(encoding="utf-8")) for path in arguments.files]
    page, left = remade(PAGE.read_text(encoding="utf-8"), files)
    PAGE.write_text(page, encoding="utf-8")
    if left:
        print(f"left as they are, for want of a file: {', '.join(left)}")


if __name__ == "__main__":
    main()
