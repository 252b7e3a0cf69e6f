"""Sections of the study file, but for its oil: what may stand in each, with units, ranges and meanings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, model_validator

from ehlcontact.capacitance import BREAKDOWN, OIL, VOLTAGE
from ehlcontact.cli import entries as e
from ehlcontact.cli.entries import Section
from reduced_models.margins.spread import KINDS, WITHIN
from reduced_models.periodic_motion.periodic import HARMONICS, SAMPLES

OF_SAMPLES = "samples", "seed"  # entries of [uncertain] itself


class Operation(Section):
    """Speed and loads. Loads are for a bearing alone: with [shaft] the discs and their weight are the load.

    A list, as [1500.0, 3000.0] of speeds, makes a study of several points. In every section an entry of one value
    may be a list, as ["C2", "CN"] of clearances; every value of it goes with every one of other lists.
    """

    speed_rpm: Annotated[e.SpeedOrRest, e.meaning("speed of the shaft, or a list")]
    radial_load: Annotated[e.LoadOrNone | None, e.meaning("radial load on the bearing, downwards")] = None
    axial_load: Annotated[
        e.AxialLoad | None,
        e.meaning(
            "axial load on the bearing: with it balls have contact angles; angular contact bearings need it"
        ),
    ] = None
    moment_x: Annotated[
        e.Moment | None,
        e.meaning("moment about x (horizontal): with it, or moment_y, the inner ring tilts freely"),
    ] = None
    moment_y: Annotated[e.Moment | None, e.meaning("moment about y (upwards)")] = None
    tilt_x_mrad: Annotated[
        e.Tilt | None, e.meaning("misalignment: tilt about x at which the inner ring is held")
    ] = None
    tilt_y_mrad: Annotated[e.Tilt | None, e.meaning("tilt about y at which the inner ring is held")] = None
    hz: Annotated[
        tuple[e.Hertz, ...] | None,
        Field(strict=False, min_length=1, description="frequencies of K and C, Hz; those about the shaft's"),
    ] = None
    layer_um: e.OilThickness | None = None
    layer_ratio: e.BearingLayerRatio | None = None
    thermal: Annotated[bool, e.meaning("films that heat up, beside isothermal ones")] = False
    contamination: Annotated[
        e.Contamination | str | None,
        e.meaning('factor e_C of ISO 281 for the modified rating life, or a class, as "normal cleanliness"'),
    ] = None
    shares: Annotated[
        tuple[e.NotNegative, ...] | None,
        Field(
            strict=False,
            min_length=1,
            description="of the time, one for each point of lists, 1 together: the points are a load spectrum",
        ),
    ] = None
    reliability: Annotated[e.Reliability, e.meaning("percent, of the modified rating life")] = 90.0


class Surface(Section):
    """Roughness, for the lambda ratio alone: films are solved between smooth surfaces."""

    rq_um: Annotated[e.Roughness | None, e.meaning("Rq of ball and race together, in place of that of each")] = (
        None
    )
    rq_ball_um: Annotated[e.Roughness | None, e.meaning("Rq of the balls; with rq_race_um or not at all")] = None
    rq_race_um: Annotated[e.Roughness | None, e.meaning("Rq of the races; with rq_ball_um or not at all")] = None


class Electric(Section):
    """Voltage across the bearings, as of a motor behind an inverter, for capacitance and field of the films."""

    voltage: Annotated[e.Voltage, e.meaning("between shaft and housing, its peak")] = VOLTAGE
    permittivity: Annotated[e.Permittivity, e.meaning("of the oil, relative to vacuum")] = OIL
    breakdown: Annotated[
        e.Breakdown,
        e.meaning(
            "field from which films are said to break down: a limit of yours; 15 to 60 are usual numbers, "
            "lower with water and age"
        ),
    ] = BREAKDOWN


class Shaft(Section):
    """The shaft of a machine, on two supports or more: round, or without mass, by its stiffness."""

    length_mm: Annotated[e.Length, e.meaning("its length; positions are distances from its left end")]
    diameter_mm: Annotated[e.Diameter | None, e.meaning("its diameter")] = None
    bore_mm: Annotated[e.Bore, e.meaning("diameter of a bore through it")] = 0.0
    density: e.Density = 7800.0
    youngs_modulus: Annotated[e.YoungsModulus, e.meaning("Young's modulus of the shaft")] = 2.06e11
    stiffness: Annotated[
        e.Stiffness | None,
        e.meaning("of a shaft without mass, in the middle between supports at its ends; in place of diameter_mm"),
    ] = None
    damping: Annotated[e.NotNegative, e.meaning("N s/m, of the shaft itself, with stiffness")] = 0.0
    damping_time: Annotated[
        e.NotNegative, e.meaning("s, of a round shaft: its damping over its stiffness, in the fixed frame")
    ] = 0.0


class Disc(Section):
    """A rigid disc on the shaft: a cylinder by its size, or by its mass."""

    position_mm: Annotated[e.Position, e.meaning("of its middle, from the left end of the shaft")]
    diameter_mm: Annotated[e.Diameter | None, e.meaning("its diameter; with width_mm")] = None
    width_mm: Annotated[e.Width | None, e.meaning("its width along the shaft")] = None
    bore_mm: Annotated[
        e.Bore | None, e.meaning("of its bore, which the shaft fills; the diameter of the shaft if left out")
    ] = None
    density: e.Density | None = None
    mass: Annotated[e.Mass | None, e.meaning("its mass, in place of its size")] = None
    diametral_inertia: Annotated[e.Inertia | None, e.meaning("kg m2, about a diameter, with mass")] = None
    polar_inertia: Annotated[e.Inertia | None, e.meaning("kg m2, about the shaft, with mass")] = None
    unbalance: Annotated[e.NotNegative, e.meaning("kg m, mass times eccentricity")] = 0.0
    balance_grade: Annotated[
        e.Positive | None,
        Field(le=4000.0, description="mm/s, G of ISO 21940-11, of its mass, in place of unbalance"),
    ] = None
    balance_speed_rpm: Annotated[
        e.Speed | None, e.meaning("of balance_grade, the highest in service; the highest of the study if left out")
    ] = None
    radial_load: Annotated[e.Force, e.meaning("N, beside its weight, downwards")] = 0.0
    axial_load: Annotated[e.Force, e.meaning("N, along the shaft, to the right")] = 0.0
    damping: Annotated[e.NotNegative, e.meaning("N s/m, of the air about it")] = 0.0


class Support(Section):
    """A bearing, or a pair of them, under the shaft: by its name in the catalogue, or by its dimensions."""

    name: Annotated[e.Text | None, e.meaning("of this support; left, right of two")] = None
    position_mm: Annotated[e.Position | None, e.meaning("from the left end of the shaft; with [shaft]")] = None
    bearing: Annotated[
        e.Catalogue | None, e.meaning("name in the catalogue, in place of the dimensions below")
    ] = None
    balls: e.Balls | None = None
    ball_diameter_mm: e.BallDiameter | None = None
    pitch_diameter_mm: e.PitchDiameter | None = None
    conformity: Annotated[
        e.Conformity | None, e.meaning("groove radius over ball diameter, of both races; 0.52 if left out")
    ] = None
    conformity_inner: Annotated[e.Conformity | None, e.meaning("of the inner race, in its place")] = None
    conformity_outer: Annotated[e.Conformity | None, e.meaning("of the outer race, in its place")] = None
    contact_angle_deg: Annotated[
        e.ContactAngle | None,
        e.meaning("free contact angle of an angular contact bearing; that of its name if left out"),
    ] = None
    clearance: Annotated[
        e.Clearance | str | None,
        e.meaning(
            'radial internal clearance, below 0 a preload; or a class, as "CN"; if left out 0, with fits or'
            " temperatures CN"
        ),
    ] = None
    dynamic_rating: Annotated[
        e.Rating | None,
        e.meaning("load rating C of the maker, for the life; that of the catalogue or the balls if left out"),
    ] = None
    static_rating: Annotated[e.Rating | None, e.meaning("load rating C0 of the maker, likewise")] = None
    shaft_fit: Annotated[
        e.Text | None,
        e.meaning('class of the shaft, as "k5": clearance is that before mounting then'),
    ] = None
    housing_fit: Annotated[e.Text | None, e.meaning('class of the bore of the housing, as "H6"')] = None
    inner_temperature: Annotated[
        e.RingTemperature | None, e.meaning("of the inner ring, with fits or alone; 20 where left out")
    ] = None
    outer_temperature: Annotated[
        e.RingTemperature | None, e.meaning("of the outer ring, with fits or alone; 20 where left out")
    ] = None
    shaft_temperature: Annotated[
        e.RingTemperature | None, e.meaning("of the shaft, with fits; that of the inner ring where left out")
    ] = None
    housing_temperature: Annotated[
        e.RingTemperature | None, e.meaning("of the housing, with fits; that of the outer ring where left out")
    ] = None
    housing_material: Annotated[
        Literal["steel", "stainless steel", "cast iron", "aluminium"], e.meaning("of the housing, with fits")
    ] = "steel"
    facing: Annotated[
        Literal["+z", "-z"] | None,
        e.meaning("direction in which the shaft presses the inner ring; +z is to the right"),
    ] = None
    spring: Annotated[
        e.RingSpring | None,
        e.meaning("N, of a spring that presses its outer ring, which slides, against facing; 0: it floats"),
    ] = None
    offset_um: e.Offset | None = None
    pair: e.Arrangement | None = None
    preload: e.Preload | None = None
    pair_spring: Annotated[
        e.Spring | None,
        e.meaning("force of a spring on the outer ring of the second of the pair, in place of preload"),
    ] = None
    distance_mm: Annotated[
        e.Distance | None, e.meaning("distance of the planes of the pair; side by side where left out")
    ] = None
    journal_mass: Annotated[
        e.NotNegative,
        e.meaning("kg, beside that of the shaft: inner ring, sleeve; a share of a shaft without mass"),
    ] = 0.0
    housing_stiffness: Annotated[
        e.Stiffness | None, e.meaning("between housing and ground, with housing_mass")
    ] = None
    housing_mass: Annotated[e.Mass | None, e.meaning("of what moves with the outer ring")] = None
    housing_damping: Annotated[e.NotNegative, e.meaning("N s/m, between housing and ground")] = 0.0
    race_control: Annotated[
        e.RaceControl | None, e.meaning("what holds the gyroscopic moment of the balls; outer where left out")
    ] = None
    turning: Annotated[
        e.Turning,
        e.meaning(
            "ring that turns at the speed; the outer one of a wheel, a sheave, on a shaft that stands still"
        ),
    ] = "inner"
    loss_factor: Annotated[e.NotNegative | None, e.meaning("of rings and fits, measured")] = None
    ball_inertia: Annotated[bool | None, e.meaning("balls vibrate between the rings; from some kHz on")] = None
    cutoff_gap_um: e.Gap | None = None
    youngs_modulus: e.YoungsModulus = 2.06e11
    poisson_ratio: e.PoissonRatio = 0.3

    @property
    def label(self) -> str:
        """Its own name, or that of its bearing."""
        return self.name or self.bearing or "ball bearing"


class Damper(Section):
    """A squeeze film damper between the housing of a support, on its springs, and the ground."""

    support: Annotated[e.Text | None, e.meaning("name of the support; the first one if left out")] = None
    length_mm: Annotated[e.FilmLand, e.meaning("of its film along the shaft")]
    diameter_mm: Annotated[e.Diameter, e.meaning("of its journal, the housing of the bearing")]
    clearance_um: Annotated[e.RadialClearance, e.meaning("radial, of the journal in the middle")]
    viscosity: Annotated[
        e.Eta0 | None, e.meaning("of the oil at the temperature of the film; that of [oil] if left out")
    ] = None
    cavitation: Annotated[
        bool, e.meaning("the half of positive pressure acts (pi film); false: the whole one, under feed pressure")
    ] = True
    seals: Annotated[
        Literal["open", "sealed"], e.meaning("ends: open (short bearing), or sealed (long bearing)")
    ] = "open"
    leakage: Annotated[e.NotNegative, Field(le=1.0), e.meaning("of sealed ends: share of the open film")] = 0.0
    groove: Annotated[bool, e.meaning("an open film fed by a groove around its middle")] = False


class Free(Section):
    """Free vibration of a mass on the contact, which a cubic element is fitted to."""

    Omega_n: Annotated[
        e.Frequency | None, e.meaning("of mass and dry contact, in u_sum/(2a); 2.56 where neither is given")
    ] = None
    hz: Annotated[e.Positive | None, e.meaning("Hz, in its place: the frequency of small dry vibrations")] = None
    periods: e.Periods = 2.5
    steps_per_period: e.Steps = 80


class Harmonic(Section):
    """Harmonic load in the band of the contact's own vibrations, which another element is fitted to."""

    Omega: Annotated[e.Frequency | None, e.meaning("frequency, in u_sum/(2a); pi where neither is given")] = None
    hz: Annotated[e.Positive | None, e.meaning("frequency in Hz, in its place")] = None
    amplitude: Annotated[e.Share, e.meaning("over the static load")] = 0.1
    periods: e.Periods = 3.0
    steps_per_period: e.Steps = 80


class RotorBand(Section):
    """Harmonic load at the speed of the shaft, which the element of the FMU is fitted to."""

    amplitude: Annotated[e.Share, e.meaning("over the static load")] = 0.25
    periods: e.Periods = 2.0
    steps_per_period: e.Steps = 40


class Contact(Section):
    """The film of the most loaded ball of a bearing, in full: its motions, and elements fitted to them."""

    support: Annotated[e.Text | None, e.meaning("name of the support; the first one if left out")] = None
    race: e.Race = "inner"
    n: Annotated[e.Intervals, e.meaning("intervals along rolling, steady film")] = 128
    n_transient: Annotated[e.Intervals, e.meaning("intervals along rolling, every film in motion")] = 128
    domain: Annotated[
        tuple[e.Finite, e.Finite, e.Finite],
        Field(
            strict=False,
            description="inlet, outlet and half width in semi-axes of the contact; damping depends on it a little",
        ),
    ] = (-4.5, 1.5, 3.0)
    free: Free = Free()
    harmonic: Harmonic = Harmonic()
    rotor_band: RotorBand = RotorBand()


class FullFilms(Section):
    """Jeffcott rotor on computed films and on elements: it turns with its unbalance, and decays after a kick.

    Mass, stiffness and unbalance are those of the machine where its shaft has a stiffness and one disc.
    """

    arrangement: Annotated[
        Literal["vee", "vertical"], e.meaning("balls that carry each journal: two at an angle, or one below")
    ] = "vee"
    half_angle_deg: Annotated[e.Finite, Field(gt=0.0, lt=90.0, description="degrees, of a vee")] = 20.0
    disc_mass: Annotated[e.Mass, e.meaning("mass of the disc")] = 2.0
    journal_mass: Annotated[e.Mass, e.meaning("mass of both journals together")] = 0.3
    shaft_stiffness: Annotated[e.Stiffness, e.meaning("of the shaft between the bearings at the disc")] = 2e8
    shaft_damping: Annotated[e.NotNegative, e.meaning("N s/m, of the shaft itself")] = 60.0
    disc_damping: Annotated[e.NotNegative, e.meaning("N s/m, of the air about the disc")] = 1.0
    unbalance: Annotated[e.Unbalance, e.meaning("mass times eccentricity")] = 4e-5
    revolutions: Annotated[
        e.Whole,
        Field(ge=2, le=100, description="revolutions computed on full films, from near the settled motion on"),
    ] = 3
    steps_per_revolution: e.Steps = 60
    kick: Annotated[e.Share, e.meaning("amplitude of the contacts' load after the kick, over that at rest")] = 0.05
    decay_periods: Annotated[
        e.Finite, Field(ge=4.0, le=100.0, description="periods of the vibration after the kick")
    ] = 8.0
    decay_steps_per_period: e.Steps = 40
    half_step: Annotated[
        bool, e.meaning("everything on full films again with half the step; the study takes about twice as long")
    ] = False


class InTime(Section):
    """The machine in time on models of its bearings: films with memory, dry, constant K and C.

    Its two bearings are alike and planar: no axial load, spring, pair or housing.
    """

    revolutions: Annotated[
        e.Whole, Field(ge=10, le=1000, description="revolutions computed; the second half of them is shown")
    ] = 30
    steps_per_revolution: Annotated[e.Whole, Field(ge=200, le=10000, description="time steps in each of them")] = (
        500
    )


class Periodic(Section):
    """Motions of the machine that repeat themselves, over the speed: all of a branch, through its folds.

    To the unbalance of its discs with bearings as means over the balls that pass, or to the balls that pass the
    load of the first bearing without unbalance: both at once have no common period.
    """

    excitation: Annotated[
        Literal["unbalance", "passage"], e.meaning("what moves it: unbalance of the discs, or passage of balls")
    ] = "unbalance"
    from_rpm: Annotated[e.Speed, e.meaning("speed at which the branch begins")]
    to_rpm: Annotated[e.Speed, e.meaning("speed at which it ends, above or below from_rpm")]
    harmonics: Annotated[e.Whole, Field(ge=1, le=200, description="of the period, in the motion")] = HARMONICS
    samples_per_period: Annotated[
        e.Whole, Field(ge=16, le=100_000, description="of the forces; at least four times the harmonics")
    ] = SAMPLES
    stability: Annotated[bool, e.meaning("Floquet multipliers: whether each of them is stable")] = True


class Defect(Section):
    """A spall in a bearing: its orders, and its force over time and as an envelope."""

    support: Annotated[e.Text | None, e.meaning("name of the support; the first one if left out")] = None
    spall: Annotated[e.Text, e.meaning("race, mm along the track, um deep, as outer,0.5,0.3")]
    cage_slip_percent: Annotated[
        e.CageSlip | None,
        e.meaning("slip of the cage in orders and lines of the spall, of its speed with balls that roll"),
    ] = None


class Uncertain(Section):
    """Entries that are not known exactly: the machine is answered for samples of them, its numbers have intervals.

    Every one stands beside `samples` and `seed`, by its section and name. `"support.clearance" = [5.0, 15.0]` is
    a range, `{normal = [10.0, 2.0]}` a mean and a standard deviation, with `within = [4.0, 16.0]` cut at these
    ends, `{triangular = [5.0, 8.0, 15.0]}` the lowest, most likely and highest value. `"support.left.clearance"`
    is that of one support; by the plain name all supports have one value. Inputs are independent of each other.
    """

    model_config = ConfigDict(extra="allow")

    samples: Annotated[
        e.Whole, Field(ge=8, le=10_000, description="machines that are answered; a power of 2 is most even")
    ] = 200
    seed: Annotated[e.Whole, Field(ge=0, le=2**32 - 1, description="of the draws")] = 0

    @model_validator(mode="before")
    @classmethod
    def _plain_names(cls, given: Any) -> Any:
        """Entries by one name, whether it is in quotes or not: support.clearance makes a table in TOML."""
        return dict(plain_names(given)) if isinstance(given, Mapping) else given

    @property
    def spreads(self) -> dict[str, Any]:
        """What is uncertain, by the name of the entry, as the file has it."""
        return dict(self.__pydantic_extra__ or {})


def plain_names(given: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Entries of [uncertain] by one name each, of tables in tables too."""
    for key, value in given.items():
        name = f"{above}{key}"
        if isinstance(value, Mapping) and name not in OF_SAMPLES and not {*KINDS, WITHIN} & set(value):
            yield from plain_names(value, f"{name}.")
        else:
            yield name, value


class Export(Section):
    """What other programs take: an FMU of the machine, or of the bearing alone; scripts of Python and for ROSS."""

    fmu: Annotated[
        bool, e.meaning("machine.fmu: the rotor on its bearings, or a bearing alone under its load, verified")
    ] = False
    outside: Annotated[
        tuple[e.Text, ...],
        Field(
            strict=False, description="names of supports whose forces are inputs of that FMU; the others inside"
        ),
    ] = ()
    inertia: Annotated[
        e.Positive | None,
        e.meaning("kg m2, of all that turns: the torque is an input then; without it the speed is"),
    ] = None
    top_rpm: Annotated[
        e.Speed | None, e.meaning("highest speed of the tables of its films; that of the study if left out")
    ] = None
    fmi: Annotated[Literal[2, 3], e.meaning("version of FMI, of FMUs of elements of [contact] too")] = 2
    platforms: Annotated[
        tuple[e.Text, ...],
        Field(
            strict=False,
            description='binaries of these FMUs, as "x86_64-linux", or "all"; this machine\'s if left out',
        ),
    ] = ()
    python: Annotated[bool, e.meaning("machine.py: the same rotor, or bearing, by calls of the library")] = False
    ross: Annotated[
        bool, e.meaning("machine_ross.py: the rotor in ROSS, on tables of K and C of its bearings")
    ] = False
    matrices: Annotated[
        tuple[e.MatrixProgram, ...],
        Field(
            strict=False,
            description="K and C of each bearing at the speed, 6 x 6, for other programs: csv, json,"
            " ansys-combi214, ansys-matrix27, nastran-cbush, nastran-dmig, abaqus, exudyn, links",
        ),
    ] = ()
    matrix_units: Annotated[Literal["m", "mm"], e.meaning("N and this, in those files but csv and json")] = "m"
    shaft_along: Annotated[
        Literal["x", "y", "z"], e.meaning("axis of the other program along the shaft, in those files")
    ] = "z"
