"""Pictures of films: coloured fringes, and a film through the last period of a harmonic load."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.film.plane import Film, Interferogram, film_of, interferogram, interpolated
from ehlcontact.results.contact_map import TALL, VIEW, ContactView, fields
from ehlcontact.results.picture import BLUE, GREEN, GREY, PURPLE, RED, AnyPanel, Line, Panel, Picture, Slides
from ehlcontact.transient.motion import HarmonicLoad
from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]

LIGHTS = (630e-9, 532e-9, 467e-9)  # m, red, green and blue
REFRACTIVE_INDEX = 1.5  # of the oil
COHERENCE = 1.5e-6  # m of film over which the fringes of the three lights fade
FINE = (166, 351)  # points of a map that shows fringes, along the shorter side and the longer one
THICKEST = 1.8  # largest central film, that the colours of films over time end at


def refined(film: Film, points: tuple[int, int], growth: float = 1.0) -> Film:
    """The part of a film that maps show, interpolated smoothly.

    Parameters
    ----------
    film : Film
    points : (int, int)
        Along rolling and across.
    growth : float
        Semi-axes over those of the static load, where the load has risen.
    """
    s = film.point.scales
    first, last, across = (growth * edge for edge in VIEW)
    x = np.linspace(max(s.a * first, film.x[0]), min(s.a * last, film.x[-1]), points[0])
    across = min(s.b * across, film.y[-1])
    return interpolated(film, x, np.linspace(-across, across, points[1]))


def coloured_fringes(result: Any) -> Picture:
    """Fringes of red, green and blue light on top of one another, of a `SteadyResult` in SI; zero film is dark."""
    film = refined(film_of(result), FINE if result.point.moes.kappa < 1.0 else FINE[::-1])
    fringes = [interferogram(film, light, REFRACTIVE_INDEX, np.pi) for light in LIGHTS]
    colours = np.stack([brightness(one, film.h / COHERENCE) for one in fringes], axis=-1)
    view = ContactView.of(film.point, film.x, film.y)
    title = f"red, green and blue light, oil of index {REFRACTIVE_INDEX}"
    return Picture([view.map(colours, "", "", None, title=title)], columns=1, heights=(TALL,), note=view.note)


def brightness(fringes: Interferogram, path: Array | float = 0.0) -> Array:
    """Fringes as a camera sees them: fading with the film, grey where the grid does not resolve them.

    Parameters
    ----------
    fringes : Interferogram
    path : array
        Film over the length in which the fringes fade; 0 where they do not.
    """
    contrast = np.exp(-(np.asarray(path) ** 2)) * fringes.resolved
    return np.asarray(0.5 + contrast * (fringes.intensity - 0.5))


def steps_of(run: SimulationResult) -> NDArray[np.int_]:
    """Steps of the last period whose whole fields were kept."""
    assert isinstance(run.motion, HarmonicLoad)
    period = run.motion.period * run.point.scales.time
    kept = run.snapshot_t[run.snapshot_t >= run.t[-1] - period * (1.0 + 1e-9)]
    return np.abs(run.t[:, None] - kept).argmin(axis=0)


def instants(run: SimulationResult) -> Slides:
    """Pressure and film, both along the mid-plane, force and film over time, with a slider through a period."""
    steps = steps_of(run)
    t, (_, unit) = run.axis("t")
    factor, shown = (1e3, "ms") if unit == "s" else (1.0, unit)
    pictures = [_instant(run, steps, int(step)) for step in steps]
    return Slides(pictures, ("time", shown), (factor * t[steps]).tolist(), runs=True)


def _instant(run: SimulationResult, steps: NDArray[np.int_], step: int) -> Picture:
    film = film_of(run, float(run.t[step]))
    view = ContactView.of(film.point, film.x, film.y)
    (p, p_label), (h, h_label) = fields(film.point, film.p, film.h)
    ends = float(run.h_min[steps].min()), THICKEST * float(run.h_central[steps].max())
    panels: list[AnyPanel] = [
        view.pressure(p, p_label, float(run.snapshot_p.max())),
        view.film(h, h_label, float(run.h_central[step]), ends),
        _midplane(run, steps, step),
        _history(run, step),
    ]
    return Picture(panels, columns=1, heights=(TALL, TALL, 200.0, 200.0), note=view.note)


def _midplane(run: SimulationResult, steps: NDArray[np.int_], step: int) -> Panel:
    """Pressure and film along y = 0; dotted at rest."""
    a = run.point.scales.a
    inside = (run.x >= a * VIEW[0]) & (run.x <= a * VIEW[1])
    (x, x_label), (p, p_label), (h, h_label) = (run.axis(name) for name in ("x", "p_midplane", "h_midplane"))
    x, p, h = x[inside], p[:, inside], h[:, inside]
    series = (("pressure", p, RED, False), ("film", h, BLUE, True))
    lines = [Line(x, values[step], name, colour, second=second) for name, values, colour, second in series]
    lines += [Line(x, values[0], "", colour, ":", second=second) for _, values, colour, second in series]
    thickest = 3.0 * float(run.axis("h_central")[0][steps].max())
    return Panel(
        lines,
        x_label,
        ("pressure", p_label[1]),
        title="along rolling, y = 0; dotted: at rest",
        x_ends=(float(x[0]), float(x[-1])),
        y_ends=(0.0, 1.08 * float(p[steps].max())),
        second=("film", h_label[1]),
        second_ends=(0.0, thickest),
    )


def _history(run: SimulationResult, step: int) -> Panel:
    """Force and central film over the run, with dots at the time of the instant."""
    (t, t_label), (force, f_label), (load, _), (film, h_label) = (
        run.axis(name) for name in ("t", "force", "load", "h_central")
    )
    now = slice(step, step + 1)
    lines = [
        Line(t, force, "force of the film", PURPLE),
        Line(t, load, "load", GREY, ":"),
        Line(t, film, "film in the centre", GREEN, second=True),
        Line(t[now], force[now], "now", RED, "", "o"),
        Line(t[now], film[now], "now", RED, "", "o", second=True),
    ]
    ends = (0.0, float(t[-1]))
    return Panel(lines, t_label, f_label, title="over time", x_ends=ends, second=("film", h_label[1]))
