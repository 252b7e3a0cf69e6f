"""`response`: force of the linearised steady contact, to its approach, speed, layer of oil, or waves.

A harmonic change of unit size makes a pressure ``P + dP exp(i Omega T)`` with

    (J + i Omega B) dP = source      on the nodes with P > 0,

J and B being the derivatives of the steady Reynolds operator and of the squeeze term to P with full elasticity
(`solver.linearised_contact`). The force is ``3/(2 pi) iint dP``. With j and b the derivatives to the approach u,
Jg and Bg those to the gap, and D the differences along X:

========= ==================================== =================================================================
change    source                               force
========= ==================================== =================================================================
approach  ``-(j + i Omega b)``                 impedance ``Z = K + i Omega C``: force over displacement, the
                                               dynamic stiffness, not the mechanical impedance (over velocity)
speed     ``d(rho H)/dX``, of u_sum (1 + s)    at low frequency what the steady force at this approach gains with
                                               ln(u_sum), at high frequency less and later, for the film has to
                                               cross the contact first
layer     oil that reaches the front of the    under a supply: the rest of a change of the layer ahead is left
          full film                            behind the contact, later
waves     ``-(Jg + i Omega Bg + rho (D + i k)) G(Omega), per height at X = 0; long waves are an approach: G tends
          g``, ``g = -exp(-i k X)``            to Z. ``|G/Z|`` is the contact filter; dry it is ``|sin(k)/k|``
========= ==================================== =================================================================

Waves of height ``exp(i (Omega T - k X))`` stand on a surface with ``dX/dT = speed = Omega/k``. The last term of
their source puts the exact change of g along X in place of the differenced one, as runs with a surface do
(`transient.transient_film`). The other responses are at fixed approach: bodies under a constant load without
inertia move apart by the force over the impedance.

Grids of half and a quarter of the intervals give error estimates (`solver.error_grids`).
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import pi
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_numbers, parts, require_positive, shown
from ehlcontact.checks.frequency import Frequency, by_name, dimensionless, is_given
from ehlcontact.checks.machine import require_threads
from ehlcontact.checks.quantity import fields_take
from ehlcontact.conditions import Conditions, between_smooth_surfaces
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.linearised_film import coarser_contacts, film_to_linearise, held, linearised
from ehlcontact.point import MoesPoint, OperatingPoint, Point, require_solvable
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results.response import APPROACH, LAYER, PARTS, SLOW, SPEED, WAVES, Response
from ehlcontact.results.steady_result import SteadyResult
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.error_estimate import response_error, wave_error
from ehlcontact.solver.grid import AUTOMATIC, Grid, require_grid
from ehlcontact.solver.level import Level
from ehlcontact.solver.linearised_contact import TOLERANCE, Forces, LinearisedContact
from ehlcontact.solver.mesh import Mesh, Solve
from ehlcontact.solver.mesh_choice import Purpose, grid_for_waves, wider_meshes
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.solver.passing_layer import on_track
from ehlcontact.supply import OilLayer

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LARGEST_OMEGA = 200.0
NEAR_ZERO = 1e-4  # where C(0) is evaluated
FEWEST_NODES = 4.0  # of the mesh to a wave, as of `Roughness`: with fewer the film does not follow it
SLOW_SHARE = 0.1  # of C at low frequency that is not in C at `SLOW`, from which it is slow oil: else 7 % at most
LONGEST = 2000.0  # semi-axes: waves as long are an approach, and in m most likely semi-axes
TO = f"{APPROACH!r}, {SPEED!r}, {LAYER!r} or Waves(...)"


@fields_take(wavelength=parts.ANY, speed=parts.ANY)
@dataclass(frozen=True, slots=True)
class Waves:
    """Straight waves on one of both surfaces, with crests across rolling; those of both surfaces add.

    Parameters
    ----------
    wavelength : float or sequence of float, optional
        Along rolling, in the units of the point of the response: m at an `OperatingPoint`, semi-axes a at a
        `MoesPoint`. By default it follows from the frequencies: ``2 pi speed/Omega`` semi-axes.
    speed : float
        dX/dT of the surface with the waves: 1 in pure rolling, ``2 u_i/u_sum`` in general.
    """

    wavelength: ArrayLike | None = None
    speed: float = 1.0

    def frequencies(self, point: Point, given: Frequency) -> Array:
        """Omega of the frequencies or wavelengths, shape (k,), at a point.

        Raises
        ------
        InputError
            Not exactly one of both; waves that do not move, too short or endless ones.
        """
        speed = require_positive("speed", self.speed)
        if self.wavelength is None:
            w = dimensionless(_time_unit(point), **given, most=LARGEST_OMEGA)
            if not w.all():
                raise InputError(next(name for name, value in given.items() if value is not None), 0.0, "> 0")
            return w
        if is_given(**given):
            allowed = "left out where a frequency is given, which it follows from"
            raise InputError("wavelength", self.wavelength, allowed)
        lengths = np.atleast_1d(as_numbers("wavelength", self.wavelength))
        if lengths.ndim != 1 or lengths.size == 0:
            raise InputError("wavelength", f"of shape {lengths.shape}", "a number, or a flat list of at least one")
        si = isinstance(point, OperatingPoint)
        unit, name = point.scales.a, "m" if si else "semi-axes a"
        least = 2.0 * pi * speed / LARGEST_OMEGA
        bad = lengths[~((lengths >= least * unit) & np.isfinite(lengths))]
        if bad.size:
            allowed = f"finite and at least {least * unit:.3g} {name}, which is Omega = {LARGEST_OMEGA:g}"
            raise InputError("wavelength", float(bad[0]), allowed)
        if si and lengths.max() > LONGEST * unit:
            allowed = f"at most {LONGEST * unit:.3g} m at an OperatingPoint (given in semi-axes a?)"
            raise InputError("wavelength", float(lengths.max()), allowed)
        return 2.0 * pi * speed * unit / lengths

    def resolved_by(self, mesh: Mesh, Omega: float, point: Point) -> Mesh:
        """`mesh`, or `InputError` where waves of this frequency have too few nodes."""
        x_in, x_out, _ = mesh.domain.as_tuple()
        least, length = FEWEST_NODES * (x_out - x_in) / mesh.n, 2.0 * pi * self.speed / Omega
        if length >= least:
            return mesh
        most = 2.0 * pi * self.speed / least
        si = isinstance(point, OperatingPoint)
        limit = f"up to {most / point.scales.time / (2.0 * pi):.3g} Hz" if si else f"Omega up to {most:.3g}"
        unit, name = point.scales.a, "m" if si else "semi-axes a"
        allowed = f"at least {least * unit:.3g} {name} ({limit}), {FEWEST_NODES:g} nodes of n = {mesh.n}: raise n"
        raise InputError("wavelength", float(f"{length * unit:.3g}"), allowed)


@between_smooth_surfaces
@by_name(1)
@one_blas_thread()
def response(
    point: Point,
    *,
    to: str | Waves = APPROACH,
    Omega: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    sliding: ShearThinning | None = None,
    threads: int | None = None,
) -> Response:
    """Linearise the converged steady contact and return its force over a small harmonic change, over frequency.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    to : "approach", "speed", "layer" or Waves
        What changes: the mutual approach; or, at fixed approach, the speed of both surfaces (large changes:
        `simulate` with a `SpeedHistory`), the layer of oil ahead under a supply, the same across, or the height of
        waves that pass on a surface.
    Omega, omega, hz, rpm : float or sequence of float
        Frequencies, in exactly one of these: dimensionless (time unit 2a/u_sum, from 0 to 200) at every point; at
        an `OperatingPoint` also in rad/s, Hz or rev/min. Waves with a wavelength have theirs from it.
    grid : Grid
        Intervals along X, by default as many as the inlet needs, 80 or more, and 16 or more to the shortest wave
        as far as is affordable; computed region, by default that of `solve_steady` (C depends on it by about
        1/extent^2); engine of the elastic deflection.
    supply : OilLayer, optional
        Oil that the surfaces carry to the contact, as in `solve_steady`; the same layer at all speeds. The front
        of the full film moves with the change: the oil that it takes up and leaves behind is part of the problem.
    thermal : Heat, or True for ``Heat()``, optional
        Let the film heat up, as in `solve_steady`; its temperatures follow the vibration as fast as oil and
        surfaces can (docs/heat.md).
    sliding : ShearThinning, optional
        Shear thinning of the film by sliding, as in `solve_steady`; it follows at once.
    threads : int, optional
        As in `solve_steady`.

    Raises
    ------
    InputError
        Frequencies not given in exactly one way, in SI at a dimensionless point, not finite, negative or above
        Omega = 200; of waves also Omega = 0, a wavelength beside a frequency, fewer than 4 nodes to a wave; a
        response to the layer of a flooded contact; a grid that would not fit into memory; more threads than cores.
    ConvergenceError
        The steady state did not converge.
    """
    started = time.perf_counter()
    moes = require_solvable(point)
    frequency: Frequency = {"Omega": Omega, "omega": omega, "hz": hz, "rpm": rpm}
    waves, w = _change(to, point, frequency)
    require_grid(grid)
    threads = require_threads("threads", threads)
    conditions = Conditions.of(supply=supply, thermal=thermal, sliding=sliding).at(point)
    if to == LAYER and conditions.supply is None:
        raise InputError("supply", None, "given in a response to the layer ahead: a flooded contact has none")
    if waves is None:
        meshes: Iterable[Mesh] = wider_meshes(moes, Purpose.DAMPING, grid, solve=Solve.IMPEDANCE)
    else:
        fine = grid_for_waves(moes, grid, 2.0 * pi * waves.speed / float(w.max()))
        wider = wider_meshes(moes, Purpose.DAMPING, fine, solve=Solve.IMPEDANCE)
        meshes = (waves.resolved_by(mesh, float(w.max()), point) for mesh in wider)
    steady = film_to_linearise(point, meshes, grid.deflection, threads, conditions)
    solved = held(steady, grid.deflection, threads)
    found = _to_approach(steady, solved, w) if to == APPROACH else _to_source(steady, solved, w, waves or str(to))
    return replace(found, seconds=time.perf_counter() - started).in_units_of(point)


@between_smooth_surfaces
@by_name(1)
def impedance(
    point: Point,
    *,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    sliding: ShearThinning | None = None,
    threads: int | None = None,
    **frequency: Unpack[Frequency],
) -> Response:
    """Stiffness K and damping C over frequency: `response` to approach, with its parameters and errors."""
    conditions: dict[str, Any] = {"supply": supply, "thermal": thermal, "sliding": sliding}
    return response(point, to=APPROACH, grid=grid, threads=threads, **conditions, **frequency)


@between_smooth_surfaces
@by_name(1)
def excitation(
    point: Point,
    *,
    wavelength: ArrayLike | None = None,
    speed: float = 1.0,
    grid: Grid = AUTOMATIC,
    supply: OilLayer | None = None,
    thermal: Heat | bool | None = None,
    sliding: ShearThinning | None = None,
    threads: int | None = None,
    **frequency: Unpack[Frequency],
) -> Response:
    """Force of waves on a surface over frequency: `response` to `Waves`, with its parameters and errors.

    `wavelength` is in the units of the point: m at an `OperatingPoint`, semi-axes a at a `MoesPoint`.
    """
    conditions: dict[str, Any] = {"supply": supply, "thermal": thermal, "sliding": sliding}
    return response(point, to=Waves(wavelength, speed), grid=grid, threads=threads, **conditions, **frequency)


def _change(to: str | Waves, point: Point, frequency: Frequency) -> tuple[Waves | None, Array]:
    """Waves, where the response is to them, and Omega, shape (k,)."""
    if isinstance(to, Waves):
        return to, to.frequencies(point, frequency)
    if not isinstance(to, str) or to not in (APPROACH, SPEED, LAYER):
        raise InputError("to", shown(to), TO)
    return None, dimensionless(_time_unit(point), **frequency, most=LARGEST_OMEGA)


def _time_unit(point: Point) -> float | None:
    """Unit of time [s], which a dimensionless point has not."""
    return None if isinstance(point, MoesPoint) else point.scales.time


def _to_approach(steady: SteadyResult, solved: Multigrid, w: Array) -> Response:
    """Impedance, dimensionless."""
    contact, moving = linearised(steady, solved), np.maximum(w, NEAR_ZERO)
    finest, *coarser = [
        (other.respond(moving, TOLERANCE), other.level)
        for other in chain([contact], coarser_contacts(steady, solved))
    ]
    Z = finest[0].force
    stiffness, damping = response_error(moving, [Z, *(other.force for other, _ in coarser)])
    if steady.temperature is not None:
        # A front of full film is slow by itself
        still = None if steady.supply is None else contact.still()
        damping = damping + slow_part(contact, moving, Z.imag / moving, still)
    behind, layer_error = _behind([finest, *coarser])
    bars = {"stiffness": stiffness, "damping": damping} | layer_error
    shared: dict[str, Any] = {"point": steady.point.moes, "film": steady, "layer_behind": behind}
    return Response.to_approach(w, Z, moving, residual=finest[0].residual, error_bars=bars, **shared)


def _to_source(steady: SteadyResult, solved: Multigrid, w: Array, to: Waves | str) -> Response:
    """Force of a change of speed, of the layer ahead, or of waves, dimensionless."""
    contact, moving = linearised(steady, solved), np.maximum(w, NEAR_ZERO)

    def forces(of: LinearisedContact) -> Forces:
        if isinstance(to, Waves):
            return of.force_of_waves(moving, moving / to.speed)
        return of.force_of_speed(moving) if to == SPEED else of.force_of_layer(moving)

    Z = contact.respond(moving, TOLERANCE).force
    found = [(forces(one), one.level) for one in chain([contact], coarser_contacts(steady, solved))]
    every, value = [one.force for one, _ in found], found[0][0].force
    shared: dict[str, Any] = {"point": steady.point.moes, "film": steady, "omega": w, "value": value}
    shared |= {"residual": found[0][0].residual, "impedance": Z}
    if not isinstance(to, Waves):
        behind, layer_error = _behind(found)
        bars = dict.fromkeys(PARTS, wave_error(every, np.abs(value))) | layer_error
        return Response(to=to, error_bars=bars, layer_behind=behind, **shared)
    error = wave_error(every, np.abs(Z))
    bars = dict.fromkeys((*PARTS, "amplitude"), error) | {"contact_filter": error / np.abs(Z)}
    lengths = 2.0 * pi * to.speed / w
    return Response(to=WAVES, wavelength=lengths, wave_speed=to.speed, error_bars=bars, **shared)


def _behind(found: Sequence[tuple[Forces, Level]]) -> tuple[Complex | None, dict[str, Array]]:
    """Layer behind, over the width of the contact, of the finest of several levels, and its error by name."""
    layers = [on_track(one.behind, level.Y) for one, level in found if one.behind is not None]
    if not layers:
        return None, {}
    return layers[0], {"layer_behind": wave_error(layers, np.abs(layers[0]))}


def slow_part(
    contact: LinearisedContact, omega: Array, damping: Array, still: LinearisedContact | None = None
) -> Array:
    """What oil that heats and cools slowly may add to C at low frequencies, (k,); 0 where it is not seen.

    It is what C changes below `SLOW`, less what it changes with temperatures that stand `still`, where given.

    Far ahead of the contact hot oil flows back beside colder oil that flows forward. Oil that warms flows back
    more and brings more heat: on few grids a line of nodes between both is near the end of its balance, and its
    temperature has a rate of some thousandths. Another n has none of it.
    """
    low, part = omega < SLOW, np.zeros_like(omega)
    if low.any():
        w = np.append(omega[low], SLOW)
        C = np.append(damping[low], contact.respond(w[-1:], TOLERANCE).force.imag / SLOW)
        if still is not None:
            C -= still.respond(w, TOLERANCE).force.imag / w
        part[low] = np.abs(C[:-1] - C[-1])
    return np.where(part > SLOW_SHARE * np.abs(damping), part, 0.0)
