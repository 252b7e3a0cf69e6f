"""Examples of every command, as its ``--help`` shows them; a test parses each."""

from __future__ import annotations

_BALL = '--bearing 6205 --oil "ISO VG 68" --temp 60 --rpm 3000 --load 1000'
EXAMPLES = {
    "init": (
        "ehlcontact init",
        'ehlcontact init mine.toml --bearing 6206 --oil "ISO VG 46" --temp 65 --rpm 6000 --load 200',
        "ehlcontact init --rpm 1500 --rpm 3000 --load 100 --load 500",
    ),
    "steady": (
        f"ehlcontact steady {_BALL} --rq 0.1",
        "ehlcontact steady --M 200 --L 10 --kappa 0.5 --figure film.png",
    ),
    "simulate": (
        f"ehlcontact simulate {_BALL} --harmonic-hz 2000 --save run.h5",
        "ehlcontact simulate --M 200 --L 10 --kappa 0.5 --free 5.13 --save free.h5",
    ),
    "impedance": (
        f"ehlcontact impedance {_BALL} --hz 50 --hz 1000",
        "ehlcontact impedance --M 200 --L 10 --kappa 0.5 --Omega 0.05 --Omega 3.14",
    ),
    "fit": (
        "ehlcontact fit free.h5 --model cubic --save element.json",
        "ehlcontact fit run.h5 --model memory --si --save memory.json",
    ),
    "element": (
        f"ehlcontact element {_BALL} --save ball.json",
        f"ehlcontact element {_BALL} --model cubic --hz 200 --save ball.json",
    ),
    "export": (
        "ehlcontact export ball.json -o ball.fmu",
        "ehlcontact export ball.json -o ball.fmu --fmi 3 --platform all --force",
        "ehlcontact export examples/small_study.toml -o rotor.fmu",
        "ehlcontact export examples/small_study.toml -o rotor.ssp",
    ),
    "validate": ("ehlcontact validate examples/small_study.toml",),
    "run": (
        "ehlcontact run examples/small_study.toml",
        "ehlcontact run examples/deep_groove_6205.toml -o results/mine --jobs 4",
        "ehlcontact run study.toml --scheduler tcp://127.0.0.1:8786",
    ),
    "reproduce": ("ehlcontact reproduce --table 3", "ehlcontact reproduce -o results/paper"),
    "bearing": (
        'ehlcontact bearing 6205 --oil "ISO VG 68" --temp 50 --load 1000 --rpm 3000 --figure bearing.png',
        "ehlcontact bearing examples/bearing_6205.toml --json -",
    ),
    "verify": ("ehlcontact verify ball.fmu",),
    "explore": ("ehlcontact explore -o page.html",),
    "atlas build": ("ehlcontact atlas build -o atlas.npz --draws 200 --processes 4",),
}


def epilog(command: str) -> str | None:
    """Examples of a command, a paragraph each; None where it has none."""
    found = EXAMPLES.get(command)
    return None if found is None else "\n\n".join(["Examples:", *found])
