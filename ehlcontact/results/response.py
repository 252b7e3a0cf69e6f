"""`Response`: force of a contact over a small harmonic change, over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.origin import freeze
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.quantities import ALONG, DAMPING, FORCE, FREQUENCY, HERTZ, LENGTH, NUMBER, STIFFNESS, Quantity
from ehlcontact.results.steady_result import DOUBTFUL, SteadyResult
from ehlcontact.results.table import Display, PointTable
from ehlcontact.solver.error_estimate import ALL
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import damping_mesh
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, counted, note_line, span

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

APPROACH, SPEED, LAYER, WAVES = "approach", "speed", "layer", "waves"
SLOW = 0.2  # Omega below which oil that heats and cools slowly may add to C
COARSE = 1.1  # mesh over the one that damping needs, from which a result says so
PARTS = "in_phase", "quadrature"
# By what a response is to: the quantity of its value, the parts that tables have, the panels of its figure
KINDS: Mapping[str, tuple[Quantity, tuple[str, ...], tuple[str, ...]]] = {
    APPROACH: (STIFFNESS, ("stiffness", "damping"), ("stiffness", "damping")),
    SPEED: (FORCE, (*PARTS, "lift"), ("in_phase quadrature", "lift")),
    LAYER: (STIFFNESS, (*PARTS, "passed_share"), ("in_phase quadrature", "passed_share")),
    WAVES: (
        STIFFNESS,
        (*PARTS, "amplitude", "wavelength", "contact_filter"),
        ("amplitude", "in_phase quadrature"),
    ),
}
OWN = {name for _, parts, _ in KINDS.values() for name in parts}


@stored("response of a contact")
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response(PointTable):
    """Force over a small harmonic change, over frequency: in the units of the point.

    Units are those at an `OperatingPoint` and, after the semicolon, at a `MoesPoint`. A contact has a number for
    each frequency, a bearing a matrix over its n directions.

    Attributes
    ----------
    to : {"approach", "speed", "layer", "waves"}
        What changes: the mutual approach; the speed of both surfaces, relative to its mean; the layer of oil
        ahead of a starved contact, the same across, at the border of the computed region; the height of waves that
        pass on a surface, at X = 0 and positive out of the surface.
    omega : ndarray, shape (k,)
        Angular frequency [rad/s; u_sum/(2a)]; at an `OperatingPoint` also ``hz``.
    value : complex ndarray, shape (k,) or (k, n, n)
        Amplitude of the force over that of the change, with ``exp(i omega t)``: the impedance K + i omega C
        [N/m; f0/delta_H], the force by the relative change of speed [N; f0], or by the thickness of the layer or
        the height of the waves [N/m; f0/delta_H]. Its parts are ``in_phase`` and ``quadrature``; a quadrature
        below zero: the force comes later.
    slope : ndarray, shape of `value`, or None
        Of a response to approach: what ``damping`` shows.
    stiffness, damping : ndarray, shape of `value`
        K(omega) = Re Z [N/m; f0/delta_H] and C(omega) = Im Z/omega, its limit at rest [N s/m; that times
        2a/u_sum], of a response to approach.
    error_bars : mapping of str to ndarray
        Half widths of the error bars of what is named, in its unit; empty where none are known. Of a solved
        contact they are estimated errors of the mesh.
    point : MoesPoint or OperatingPoint, or None
        The contact; None where it is not known, or where there are several.
    film : SteadyResult or None
        The film at rest that was linearised: mesh, approach, thickness, oil supply, temperatures.
    residual : ndarray, shape (k,), or None
        Relative residual of the linear system.
    impedance : complex ndarray, shape (k,), or None
        Of the contact at the frequencies of a response to speed, layer or waves.
    layer_behind : complex ndarray, shape (k,), or None
        Of a starved contact, in a response to approach or layer: amplitude of the layer that it leaves, mean over
        its width 2b, over that of the change. Oil is seen where it leaves the computed region: its phase has the
        time of the way through the region.
    wavelength : ndarray, shape (k,), or None
        Of waves, along rolling [m; a].
    wave_speed : float
        Speed of the waves over the mean speed of both surfaces.
    units : {"SI", "dimensionless"}
        Of the numbers: those of the point; where none is known, as given.
    seconds : float
        Wall time of the solve.
    beyond_data : str
        Loads and frequencies outside those of the data, in words, part of ``reservation``; empty where none.
    """

    to: str = APPROACH
    omega: Annotated[Array, FREQUENCY.over("omega")]
    value: Annotated[Complex, STIFFNESS.over("omega", listed=False)]
    slope: Annotated[Array | None, DAMPING.over("omega", listed=False)] = None
    error_bars: Mapping[str, Array] = field(default_factory=dict)
    point: Point | None = None  # type: ignore[assignment]  # nothing is converted where it is None
    film: SteadyResult | None = None
    residual: Annotated[Array | None, NUMBER.over("omega")] = None
    impedance: Annotated[Complex | None, STIFFNESS.over("omega", listed=False)] = None
    layer_behind: Annotated[Complex | None, NUMBER.over("omega", listed=False)] = None
    wavelength: Annotated[Array | None, ALONG.over("omega")] = None
    wave_speed: float = 1.0
    units: str = "SI"
    seconds: float = 0.0
    beyond_data: str = ""

    DISPLAY: ClassVar[Display] = Display(rows="omega", logs="x")

    def __post_init__(self) -> None:
        if self.point is not None:
            object.__setattr__(self, "units", "SI" if self._in_si() else "dimensionless")
        freeze(self)

    @classmethod
    def to_approach(cls, omega: Array, Z: Complex, moving: Array, **others: Any) -> Self:
        """Response with the impedance Z at frequencies `moving` > 0, which stand for `omega` >= 0."""
        over = (slice(None), *(None,) * (Z.ndim - 1))
        value = np.where((omega > 0.0)[over], Z, Z.real)
        return cls(omega=omega, value=value, slope=Z.imag / moving[over], **others)

    def __getitem__(self, kept: Any) -> Self:
        """The response at some of its frequencies: a slice, or a mask over them."""
        over = ("omega", "value", "slope", "residual", "impedance", "layer_behind", "wavelength")
        arrays = {name: getattr(self, name) for name in over}
        some: dict[str, Any] = {name: array if array is None else array[kept] for name, array in arrays.items()}
        return replace(self, **some, error_bars={name: bar[kept] for name, bar in self.error_bars.items()})

    @property
    def hz(self) -> Annotated[Array, HERTZ.over("omega").in_si_only()]:
        """Frequencies [Hz]; raises `InputError` of a response without a unit of time."""
        if not self._in_si():
            raise InputError("hz", "asked for", "omega of a dimensionless response, which has no seconds")
        return np.asarray(self.omega / (2.0 * np.pi))

    @property
    def stiffness(self) -> Annotated[Array, STIFFNESS.over("omega")]:
        """K(omega), of a response to approach."""
        return self._of(APPROACH, "stiffness", self.value.real)

    @property
    def damping(self) -> Annotated[Array, DAMPING.over("omega")]:
        """C(omega), of a response to approach."""
        return self._of(APPROACH, "damping", self.slope)

    @property
    def in_phase(self) -> Annotated[Array, STIFFNESS.over("omega")]:
        """Real part of the value."""
        return self.value.real

    @property
    def quadrature(self) -> Annotated[Array, STIFFNESS.over("omega")]:
        """Imaginary part of the value."""
        return self.value.imag

    @property
    def amplitude(self) -> Annotated[Array, STIFFNESS.over("omega")]:
        """Size of the value."""
        return np.abs(self.value)

    @property
    def lift(self) -> Annotated[Array, LENGTH.over("omega")]:
        """Amplitude with which bodies under a constant load, without inertia, move apart by a change of speed."""
        return self._of(SPEED, "lift", self.impedance, moved=True)

    @property
    def passed_share(self) -> Annotated[Array, NUMBER.over("omega")]:
        """``|layer_behind|``, of a response to layer: share of a change of it that the contact passes on."""
        return np.abs(self._of(LAYER, "passed_share", self.layer_behind))

    @property
    def contact_filter(self) -> Annotated[Array, NUMBER.over("omega")]:
        """``|G/Z|``: share of the height of waves that acts like an approach."""
        return self._of(WAVES, "contact_filter", self.impedance, moved=True)

    @property
    def loss_factor(self) -> Annotated[Array, NUMBER.over("omega", listed=False)]:
        """``omega C/K``, of a response to approach; of a bearing that of each direction, shape (k, n)."""
        K, C = self._diagonals(self.stiffness), self._diagonals(self.damping)
        return np.asarray(self.omega.reshape(-1, *(1,) * (K.ndim - 1)) * C / K)

    @property
    def reservation(self) -> str:
        """What the response leaves open, in words: a coarse mesh, a large error, `beyond_data`; else empty."""
        found = []
        if self.film is not None and self.to == APPROACH:
            moes = self.film.point.moes
            mesh, needed = Mesh(self.film.n, self.film.domain, moes.kappa), damping_mesh(moes)
            if mesh.size > COARSE * needed:
                apart = f"nodes are {mesh.size:.2g} semi-axes apart, damping needs {needed:.2g}"
                found.append(f"the grid is too coarse: {apart}")
        return "; ".join([*found, *filter(None, [self._doubt(coarse=bool(found)), self.beyond_data])])

    def _doubt(self, coarse: bool) -> str:
        """The largest error over its quantity, in words, where it is doubtful."""
        name, words = {
            APPROACH: ("damping", "C"),
            SPEED: ("in_phase", "the force"),
            LAYER: ("in_phase", "the force"),
            WAVES: ("contact_filter", "the force of these waves"),
        }[self.to]
        if name not in self.error_bars:
            return ""
        share = self._share(name)
        worst = int(np.argmax(share))
        if share[worst] <= DOUBTFUL:
            return ""
        bar = "anything" if share[worst] >= ALL else f"{100.0 * share[worst]:.0f} %"
        if self.to == WAVES:
            bar += " of height times |Z|"
        film, slow = self.film, ""
        if film is not None and self.to == APPROACH and not coarse:
            # A front of full film is slow by itself
            heated = film.temperature is not None and film.supply is None
            if heated and self.dimensionless.omega[worst] < SLOW:
                slow = " (perhaps by slow oil ahead of the contact: compare another n)"
        return f"{words} may be off by {bar} at {self._frequency(worst)}{slow}"

    def _share(self, name: str) -> Array:
        """Error of a quantity over it, shape (k,); of a contact filter itself, of parts over their amplitude."""
        if name == "contact_filter":
            return np.asarray(self.error_bars[name])
        own = self.amplitude if name in PARTS else np.abs(getattr(self, name))
        return np.asarray(self.error_bars[name] / own)

    @property
    def negative_damping(self) -> str:
        """Where damping is negative, with the loss factor that outweighs it, in words; else empty.

        Rings, fits and mounts whose loss factor is larger than ``omega |C|/K`` at all these frequencies take more
        out of a vibration than the contact gives.
        """
        if self.to != APPROACH:
            return ""
        C = np.atleast_2d(self._diagonals(self._with_sign()).T).T
        at = np.flatnonzero((C < 0.0).any(axis=1))
        if not at.size:
            return ""
        K = np.atleast_2d(self._diagonals(self.stiffness).T).T
        gained = float((-self.omega[:, None] * C / K).max())
        first, last = self._frequency(at[0]), self._frequency(at[-1])
        where = f"at {first}" if at.size == 1 else f"from {first} to {last}"
        return f"damping is negative {where}; a loss factor above {gained:.2g} outweighs it (omega |C|/K)"

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return "" if self.film is None else self.film.outside_assumptions

    @property
    def dimensionless(self) -> Self:
        """The response in Moes units; raises `InputError` where no point is known that has them."""
        if self.point is None:
            if self._in_si():
                raise InputError("point", None, "known: a response without a contact has no other units")
            return self
        return PointTable.dimensionless.fget(self)  # type: ignore[attr-defined]

    def to_control(self) -> Any:
        """``control.FrequencyResponseData``: ``u`` to ``F``, or ``u_x, u_y, ...`` to ``F_x, F_y, ...``."""
        import control

        Z = np.moveaxis(self.value, 0, -1)
        axes = self._display().labels.get("axis", ())
        change = {APPROACH: "u", SPEED: "s", LAYER: "m", WAVES: "h"}[self.to]
        inputs, outputs = ([f"{change}_{x}" for x in axes], [f"F_{x}" for x in axes]) if axes else (change, "F")
        return control.frd(Z, self.omega, inputs=inputs, outputs=outputs, name="contact")

    def to_dict(self) -> dict[str, Any]:
        """Quantities and origin, ready for JSON."""
        missing = [name for name in ("residual", "wavelength") if getattr(self, name) is None]
        found = {"to": self.to} | {k: v for k, v in PointTable.to_dict(self).items() if k not in missing}
        if self.beyond_data:
            found |= {"reservation": self.reservation}
        if self.film is not None:
            found |= {"reservation": self.reservation, "outside_assumptions": self.outside_assumptions}
            found |= {"seconds": self.seconds, "film": self.film.to_dict()}
        if self.to == WAVES:
            found |= {"wave_speed": self.wave_speed}
        point = None if self.point is None else self.point.to_dict()
        return found | {"negative_damping": self.negative_damping, "point": point}

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless all arrays have one value, or matrix, per frequency."""
        if self.to not in KINDS:
            raise ValueError(f"to is {self.to!r}")
        if self.value.shape[:1] != self.omega.shape or (self.to == APPROACH) == (self.slope is None):
            raise ValueError(f"{self.value.shape} values at {self.omega.shape} frequencies")
        for name in ("slope", "residual", "impedance", "layer_behind", "wavelength"):
            array = getattr(self, name)
            if array is not None and np.shape(array)[:1] != self.omega.shape:
                raise ValueError(f"{name} has the shape {np.shape(array)}, not {self.omega.shape}")
        for name, bar in self.error_bars.items():
            if np.shape(bar) != self.omega.shape:
                raise ValueError(f"the error of {name} has the shape {np.shape(bar)}, not {self.omega.shape}")

    def _in_si(self) -> bool:
        return self.units == "SI" if self.point is None else isinstance(self.point, OperatingPoint)

    def _of(self, kind: str, name: str, array: Any, *, moved: bool = False) -> Any:
        """An array that a response to `kind` alone has: `array`, or the value over it."""
        if self.to != kind or array is None:
            raise InputError(name, self.to, f"asked of a response to {kind}")
        return np.abs(self.value / array) if moved else array

    def _with_sign(self) -> Array:
        """Damping, below zero too where what is solved has it so."""
        return self.damping

    def _diagonals(self, array: Array) -> Array:
        """Directions by themselves: shape (k,), or (k, n) of matrices."""
        return array if array.ndim == 1 else np.asarray(np.einsum("kii->ki", array))

    def _frequency(self, k: int) -> str:
        return f"{self.hz[k]:.4g} Hz" if self._in_si() else f"omega {self.omega[k]:.4g}"

    def _quantities(self) -> Mapping[str, Quantity]:
        """Declared quantities: the value and its parts in the unit of what the response is to; matrices."""
        own = {"value", *PARTS, "amplitude"}
        unit, _, _ = KINDS[self.to]
        found = {
            name: replace(unit, dims=one.dims, listed=one.listed) if name in own else one
            for name, one in PointTable._quantities(self).items()
        }
        if self.value.ndim == 1:
            return found
        matrices = {"value", "slope", "stiffness", "damping", *PARTS, "amplitude"}
        return {
            name: replace(one, dims=("omega", "axis", "by")) if name in matrices else one
            for name, one in found.items()
        }

    def _declared(self) -> Mapping[str, Quantity]:
        """Quantities of tables and figures: those of its kind, which are real."""
        hidden = {"value", "slope", "impedance", "layer_behind", "loss_factor", *(OWN - set(KINDS[self.to][1]))}
        return {name: one for name, one in PointTable._declared(self).items() if name not in hidden}

    def _display(self) -> Display:
        logs = "xy" if self.to == APPROACH and self.value.ndim == 1 else "x"
        along = "hz" if self._in_si() else ""
        return replace(self.DISPLAY, panels=KINDS[self.to][2], logs=logs, coordinates=along)

    def _summary_lines(self) -> list[str]:
        origin = "" if self.film is None else f"; linearised on n = {self.film.n}"
        return [
            *([] if self.point is None else [contact_text(self.point)]),
            f"{counted(self.omega.size, 'frequency', 'frequencies')}, {self._band()}{origin}",
            self._numbers(),
            *filter(None, [self.negative_damping, self._heat(), self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    def _band(self) -> str:
        return f"{span(self.hz)} Hz" if self._in_si() else f"omega {span(self.omega)}"

    def _heat(self) -> str:
        film = self.film
        return (
            "" if film is None or film.temperature is None else film.temperature.summary(film.sliding is not None)
        )

    def _numbers(self) -> str:
        """Ranges of the quantities, with their errors."""
        si = self._in_si()
        rigid, force = ((1e-6, "N/µm"), (1.0, "N")) if si else ((1.0, ""), (1.0, ""))
        if self.to == APPROACH:
            found = [
                f"stiffness K {span(self.stiffness, *rigid)}",
                f"damping C {span(self.damping, 1.0, 'N s/m' * si)}",
            ]
            if "damping" in self.error_bars:
                shares = (100.0 * self._share(name) for name in ("stiffness", "damping"))
                found = [f"{text} (± {span(np.round(s, 2))} %)" for text, s in zip(found, shares, strict=True)]
            return ", ".join(found)
        phase = f"phase {span(np.round(np.degrees(np.angle(self.value))) + 0.0)}°"
        if self.to == SPEED:
            return f"force over relative change of speed {span(self.amplitude, *force)}, {phase}"
        if self.to == LAYER:
            passed = f"passes on {span(self.passed_share)} of it"
            return f"force over thickness of the layer ahead {span(self.amplitude, *rigid)}, {phase}, {passed}"
        unit = (1e6, "µm") if si else (1.0, "a")
        waves = f"waves of {span(self.wavelength, *unit)}"  # type: ignore[arg-type]
        size, share = span(self.amplitude, *rigid), span(self.contact_filter)
        return f"{waves}: force over height |G| {size}, {phase}, filter |G/Z| {share}"
