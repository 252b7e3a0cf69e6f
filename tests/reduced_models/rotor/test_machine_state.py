"""`machine_state`: the motor of the guide, a bearing with a spring alone, and what is refused."""

import json
from dataclasses import replace
from math import degrees

import numpy as np
import pytest

from ehlcontact import InputError, Lubricant
from reduced_models import (
    BallBearing,
    Disc,
    Rotor,
    Shaft,
    SqueezeFilmDamper,
    Support,
    jeffcott_rotor,
    machine_state,
    rotor_on_bearings,
    unbalance_response,
)
from reduced_models.rotor.machine_state import MachineState, single_bearing_state
from reduced_models.rotor.machine_tiles import SKF_WITHOUT_PRELOAD, digits
from reduced_models.rotor.support_state import support_state

OIL = Lubricant.iso_vg(32, temperature=80.0)
RPM = 15000.0


def bearing(name: str, **changes: object) -> BallBearing:
    return BallBearing.catalogue(name, **{"clearance": "CN", "oil": OIL, "rq_race": 1e-7, **changes})


def motor() -> Rotor:
    """A shaft of 35 mm on a 6306 and a 6206, which a spring presses."""
    return rotor_on_bearings(
        Shaft(length=0.36, diameter=0.035),
        discs=[Disc.cylinder(position=0.18, diameter=0.11, width=0.12, bore=0.035, unbalance=1e-5)],
        supports=[
            Support(position=0.03, bearing=bearing("6306"), facing="-z"),
            Support(position=0.33, bearing=bearing("6206"), facing="+z", preload=200.0),
        ],
    )


@pytest.fixture(scope="module")
def machine() -> MachineState:
    return machine_state(motor(), RPM, names=("left", "right"), positions=(0.03, 0.33))


@pytest.mark.long
class TestMotor:
    def test_films_and_friction(self, machine: MachineState) -> None:
        left, right = machine.supports
        assert left.label == "left 6306"
        assert (left.h_min, right.h_min) == pytest.approx((3.6901e-7, 3.2154e-7), rel=1e-4, abs=0.0)
        assert (left.lambda_ratio, right.lambda_ratio) == pytest.approx((3.690, 3.215), rel=1e-3)
        assert (left.film_torque, right.film_torque) == pytest.approx((0.05853, 0.04537), rel=1e-3)
        assert (left.torque, right.torque) == (left.skf_torque, right.skf_torque)
        assert left.loss == pytest.approx(left.torque * RPM * np.pi / 30.0, rel=1e-12)
        assert machine.worst_support is right

    def test_balls(self, machine: MachineState) -> None:
        left, right = machine.supports
        assert (left.ball_load, right.ball_load) == pytest.approx((111.4, 95.9), rel=1e-3)
        assert left.p_hertz == pytest.approx(0.957e9, rel=2e-3)
        angles = left.contact_angles
        assert [degrees(angle) for angle in angles] == pytest.approx([14.58, 7.99], rel=0.02)

    def test_vibrations(self, machine: MachineState) -> None:
        hz = [mode.hz for mode in machine.modes]
        assert hz[1:5] == pytest.approx([266.1, 266.6, 778.2, 961.4], rel=2e-4)
        speeds = [one.speed_rpm for one in machine.critical_speeds]
        assert speeds == pytest.approx([10363.0, 15926.0, 15958.0], rel=5e-4)
        assert machine.nearest_critical.speed_rpm == speeds[2]  # forward; the other one is backward
        assert machine.margin(machine.nearest_critical) == pytest.approx(0.0638, rel=5e-3)
        most = machine.largest_response
        assert most.node == "disc"
        assert most.speed_rpm == pytest.approx(16000.0, rel=1e-12)
        assert most.size == pytest.approx(194.8e-6, rel=1e-3, abs=0.0)
        assert machine.response_at_speed.size == pytest.approx(7.956e-6, rel=1e-3, abs=0.0)
        fine = unbalance_response(motor(), speeds[2] + np.linspace(-1.5, 1.5, 31))  # rev/min about the peak
        assert machine.largest_peak.size == pytest.approx(fine.major.max(), rel=0.05, abs=0.0)

    def test_for_many_machines(self, machine: MachineState) -> None:
        """Fewer speeds and no highest speed: the same numbers, for a quarter of the time."""
        rough = machine_state(motor(), RPM, names=("left", "right"), positions=(0.03, 0.33), fine=False)
        (own,) = (one for one in rough.critical_speeds if rough.is_excited(one))
        nearest = machine.nearest_critical
        assert own.speed_rpm == pytest.approx(nearest.speed_rpm, rel=1e-5)
        assert own.decrement == pytest.approx(nearest.decrement, rel=1e-3)
        assert rough.largest_peak.size == pytest.approx(machine.largest_peak.size, rel=1e-3, abs=0.0)
        for name in ("h_min", "lambda", "l10rh", "torque", "mode_hz", "mode_damping", "response", "capacitance"):
            assert rough.numbers[name] == machine.numbers[name], name
        assert rough.highest_speed == np.inf and not rough.failed
        assert len(rough.diagram.speed_rpm) == 9  # six, and the critical speeds

    def test_data_end_where_balls_are_too_heavy(self, machine: MachineState) -> None:
        assert 1.9e5 < machine.highest_speed < 1.95e5
        assert "end of the atlas" in machine.ends
        with pytest.raises(InputError, match="outer race"):
            motor().equilibrium(1.01 * machine.highest_speed)
        motor().equilibrium(0.99 * machine.highest_speed)

    def test_tiles_and_reservations(self, machine: MachineState) -> None:
        tiles = {tile.name: tile for tile in machine.tiles()}
        assert tiles["smallest film"][1:3] == ("0.322", "µm")
        assert "0.369 µm, lambda 3.69" in tiles["smallest film"].note
        assert tiles["nearest critical speed"].value == "15957"  # that which whirls forward
        said = "6.4 % above the speed; forward whirl; all: 10367 along the shaft, 15924 backward"
        assert said in tiles["nearest critical speed"].note
        response = tiles["response to unbalance at 15000 rev/min"]
        assert response.value == "7.96" and response.note.startswith("at the disc; linear peak ")
        assert "at 15957 rev/min; 195 µm at 16000 rev/min" in response.note
        assert [text.split(":")[0] for text in machine.reservations] == ["left 6306", "right 6206"]
        assert all(": isothermal: " in text and "%" in text for text in machine.reservations)
        assert tiles["stiffness of the most loaded bearing at 250 Hz"].note.startswith("damping 32.7 N s/m")
        assert "175 N at the outer race" in tiles["largest ball load"].note
        heavier, other = machine.supports
        assert other.p_hertz > heavier.p_hertz and other.ball_load < heavier.ball_load
        most = f"largest Hertz pressure {1e-9 * other.p_hertz:.3g} GPa, right 6206"
        assert most in tiles["largest ball load"].note
        _, least, largest = (
            sum(ends) for ends in zip(*(s.capacitance_range for s in machine.supports), strict=True)
        )
        assert f"{1e12 * least:.3g} and {1e12 * largest:.3g} pF" in tiles["capacitance of the films"].note
        assert "V/µm in the thinnest film per volt" in tiles["capacitance of the films"].note
        (field,) = (tile for tile in replace(machine, voltage=10.0).tiles() if tile.number == "field")
        assert field.value == f"{10.0 * max(one.field_per_volt for one in machine.supports):.3g}"
        assert field.note.startswith("10 V between shaft and housing; right 6206; ")
        assert "times the limit of 15 V/µm from which films are said to break down" in field.note
        assert "\n" not in "".join(map(str, machine.tiles()))
        assert tiles["smallest film"].brief == "smallest film 0.322 µm (lambda 3.22, right 6206 inner race)"

    def test_critical_is_the_speed_next_to_a_mode_of_the_shaft(self, machine: MachineState) -> None:
        (concern,) = machine.concerns
        assert concern.startswith(
            "unbalance excites a mode at 15957 rev/min, 6.4 % above the speed: 86 % of its strain energy"
        )
        assert "stiffer or shorter shaft" in concern
        marked = [tile.name for tile in machine.tiles() if tile.critical]
        assert marked == ["nearest critical speed"]

    def test_modes_along_the_shaft_are_no_concern_of_unbalance(self, machine: MachineState) -> None:
        axial, backward, forward = machine.critical_speeds
        assert [machine.is_axial(one) for one in (axial, backward, forward)] == [True, False, False]
        near = replace(machine, speed_rpm=axial.speed_rpm * 1.02, response=None)
        assert near.concerns == ()
        assert near.nearest_critical == forward  # by the speed that unbalance excites

    def test_modes_of_which_unbalance_excites_little_are_not_excited(self, machine: MachineState) -> None:
        axial, backward, forward = map(machine.amplification, machine.critical_speeds)
        assert 0.5 < axial < 1.0 and backward < 0.5 and forward > 1e3

    def test_no_critical_speed_says_how_far_it_was_looked_for(self, machine: MachineState) -> None:
        slow = replace(machine.diagram, omega=3.0 * machine.diagram.omega[:, 1:])
        tile = next(one for one in replace(machine, diagram=slow).tiles() if one.name == "critical speed")
        assert (tile.value, tile.unit) == ("none up to 30000", "rev/min")
        assert tile.note == "above 2000 rev/min"

    def test_films_are_as_sure_as_atlas_and_oil(self, machine: MachineState) -> None:
        support = machine.worst_support
        answer = support.bearing.race("inner").answer(support.ball_load, RPM)
        assert support.film_errors["atlas"] == pytest.approx(answer.error_bars["h_min"] / answer.h_min, rel=0.05)
        thicker = replace(OIL, eta0=OIL.eta0 * (1.0 + OIL.eta0_scatter))
        changed = replace(support.bearing, oil=thicker).race("inner").answer(support.ball_load, RPM)
        by_viscosity = changed.h_central / answer.h_central - 1.0
        assert by_viscosity < support.film_errors["oil"] < by_viscosity + OIL.alpha_scatter

    def test_life_is_that_of_all_bearings_together(self, machine: MachineState) -> None:
        system, tile = machine.rating_life, next(one for one in machine.tiles() if one.name == "rating life")
        each = [support.state.life().l10rh for support in machine.supports]
        assert [one.l10rh for one in system] == each and system.names == ("left 6306", "right 6206")
        assert system.l10rh < min(each) and float(tile.value) == pytest.approx(system.l10rh, rel=5e-3)
        assert "an oil and a contamination" in tile.note and machine.to_dict()["life"]["lnmrh"] is None
        clean = replace(machine, contamination=0.5, reliability=95.0)
        tile = next(one for one in clean.tiles() if one.name == "rating life")
        assert float(tile.value) == pytest.approx(clean.rating_life.lnmrh, rel=5e-3)
        assert tile.note.startswith("modified, 95 %, by nu/nu1, by the solved film")

    def test_life_names_what_limits_it(self, machine: MachineState) -> None:
        """a_ISO at 50, radial loads below the least one, and the clearances between which the life is."""
        clean = replace(machine, contamination=1.0, clearances=((2e-6, 9e-6), (3e-6, 8e-6)))
        system, tile = clean.rating_life, next(one for one in clean.tiles() if one.name == "rating life")
        capped = [name for name, one in zip(system.names, system, strict=True) if one.a_iso == 50.0]
        assert f"a_ISO of {', '.join(capped)} at its cap of 50" in tile.note and capped
        light = [one.loads.radial < one.least_load <= one.equivalent_load for one in system]
        assert "left 6306 2 µm, right 6206 3 µm, and" in tile.note
        assert tile.note.count("below the least load") == sum(light)

    def test_whole_answer_is_json(self, machine: MachineState) -> None:
        found = json.loads(json.dumps(machine.to_dict()))
        assert [one["name"] for one in found["supports"]] == ["left", "right"]
        assert found["critical_speeds"][0]["margin"] < 0.0 < found["critical_speeds"][1]["margin"]
        assert len(found["tiles"]) == len(machine.tiles())

    def test_picture_shows_the_crossings_of_modes_and_speed(self, machine: MachineState) -> None:
        zone, diagram = machine.picture().panels
        assert zone.title == "left 6306: force on the balls [N]"
        assert diagram.y_ends == (0.0, pytest.approx(2.0 * 28000.0 / 60.0, rel=0.1))

    def test_supports_are_those_under_the_forces_of_the_rotor(self, machine: MachineState) -> None:
        for support in machine.supports:
            alone = support_state(support.bearing, support.state.load, RPM)
            assert alone.h_min == pytest.approx(support.h_min, rel=1e-6, abs=0.0)
            assert np.diag(alone.stiffness) == pytest.approx(np.diag(support.stiffness), rel=1e-6)


@pytest.mark.long
class TestAxialModeThatBearingsCouple:
    """A belt pulls one end down: its bearing has K_yz twice as large as K_zz."""

    def belt(self) -> Rotor:
        oil = Lubricant.iso_vg(100, temperature=70.0)
        discs = [
            Disc(position=0.02, mass=2.0, diametral_inertia=3e-3, polar_inertia=5e-3, load=(0.0, -800.0)),
            Disc(position=0.23, mass=12.0, diametral_inertia=0.03, polar_inertia=0.024, unbalance=5e-5),
        ]
        supports = [
            Support(position=0.08, bearing=bearing("6207", oil=oil, clearance=1e-5), facing="-z"),
            Support(position=0.38, bearing=bearing("6206", oil=oil, clearance=1e-5), facing="+z", preload=250.0),
        ]
        return rotor_on_bearings(Shaft(length=0.42, diameter=0.035), discs=discs, supports=supports)

    def test_is_excited(self) -> None:
        machine = machine_state(self.belt(), 5600.0)
        stiffness = machine.supports[0].stiffness
        assert abs(stiffness[1, 2]) > 1.5 * stiffness[2, 2]
        (critical,) = machine.critical_speeds
        assert machine.is_axial(critical) and machine.is_excited(critical)
        assert machine.numbers["critical_rpm"] == critical.speed_rpm
        near = critical.speed_rpm * np.array([0.97, 0.9998, 0.9999, 1.0, 1.0001, 1.0002, 1.03])
        size = unbalance_response(self.belt(), near).major.max(axis=1)
        assert size.max() > 50.0 * max(size[0], size[-1])
        assert machine.largest_peak.size == pytest.approx(size.max(), rel=0.2, abs=0.0)
        (concern,) = (text for text in machine.concerns if text.startswith("unbalance excites"))
        assert concern.startswith("unbalance excites a mode along the shaft at")
        tile = next(one for one in machine.tiles() if one.number == "critical_rpm")
        assert tile.critical and "along the shaft: unbalance excites it to" in tile.note


class TestBearingAlone:
    def test_with_a_spring(self) -> None:
        machine = single_bearing_state(bearing("6206", rq_ball=3e-8), (0.0, -59.0, 200.0), RPM)
        support = machine.supports[0]
        assert support.ball_load == pytest.approx(97.55, rel=1e-4)
        assert (1e6 * support.h_min, support.lambda_ratio) == pytest.approx((0.3212, 3.076), rel=1e-3)
        assert machine.modes == machine.critical_speeds == ()
        assert machine.largest_response is None
        assert {tile.name for tile in machine.tiles()} >= {"smallest film", "largest ball load", "friction torque"}

    def test_friction_by_skf_does_not_have_a_preload(self) -> None:
        for clearance, said in ((-2e-6, True), (0.0, False)):
            machine = single_bearing_state(replace(bearing("6206"), clearance=clearance), (0.0, -300.0), RPM)
            note = next(tile.note for tile in machine.tiles() if tile.name == "friction torque")
            assert machine.supports[0].relies_on_skf and (SKF_WITHOUT_PRELOAD in note) is said

    def test_friction_is_that_of_films_at_low_speed(self) -> None:
        support = support_state(bearing("6205"), (0.0, -500.0), 3000.0)
        assert not support.relies_on_skf
        assert support.torque == support.friction[0].total

    @pytest.mark.long
    def test_a_jump_of_the_friction_over_speeds_has_both_of_its_ends(self) -> None:
        low, high = (single_bearing_state(bearing("6205"), (0.0, -500.0), rpm) for rpm in (5000.0, 5001.0))
        ends = []
        for machine in (low, high):
            tile = next(tile for tile in machine.tiles() if tile.name == "friction torque")
            support = machine.supports[0]
            flooded, skf = support.flooded_torque, support.skf_torque
            own, other = (skf, flooded) if support.relies_on_skf else (flooded, skf)
            assert tile.value == digits(own) and f" 5000 rev/min: {digits(other)} N m" in tile.note
            ends.append((flooded, skf))
        assert ends[0] == pytest.approx(ends[1], rel=1e-3)
        assert not low.supports[0].relies_on_skf and high.supports[0].relies_on_skf

    def test_thin_films_are_critical(self) -> None:
        machine = single_bearing_state(bearing("6205", rq_race=4e-7), (0.0, -500.0), 3000.0)
        assert machine.supports[0].lambda_ratio < 3.0
        assert machine.concerns[0].startswith("lambda ") and "thicker oil" in machine.concerns[0]
        assert machine.tiles()[0].critical

    def test_dry_has_loads_alone(self) -> None:
        machine = single_bearing_state(bearing("6205").dry, (0.0, -500.0), 3000.0)
        assert machine.highest_speed == np.inf
        assert machine.supports[0].h_min is machine.supports[0].torque is None
        assert next(tile.name for tile in machine.tiles()) == "largest ball load"


class TestRefused:
    def test_rotor_without_ball_bearings(self) -> None:
        rotor = jeffcott_rotor(disc_mass=1.0, journal_mass=0.1, shaft_stiffness=1e7, half_angle=0.5)
        with pytest.raises(InputError, match="ball bearings"):
            machine_state(rotor, RPM)

    def test_names_for_another_number_of_bearings(self) -> None:
        with pytest.raises(InputError, match="names"):
            machine_state(motor(), RPM, names=("left",))


@pytest.mark.long
def test_soft_housings_move_with_their_bearings() -> None:
    """The advice is about the springs of the housings; a ring moves in the other by far less than with it."""

    def fan(unbalance: float, damper: SqueezeFilmDamper | None = None) -> MachineState:
        seat = {"bearing": bearing("6205", clearance=-3e-6), "housing_mass": 0.4, "housing_stiffness": 4e6}
        seat["damper"] = damper
        rotor = rotor_on_bearings(
            Shaft(length=0.3, diameter=0.03),
            discs=[Disc.cylinder(position=0.15, diameter=0.15, width=0.05, bore=0.03, unbalance=unbalance)],
            supports=[Support(position=0.03, **seat), Support(position=0.27, **seat)],
        )
        return machine_state(rotor, 9000.0, names=("left", "right"), fine=False)

    state = fan(2e-5)
    critical, *others = state.concerns
    assert not any("in its outer ring" in text for text in others)
    assert state.modes[0].housing_share == pytest.approx(0.803, abs=2e-3)
    assert "80 % in springs of housings, so stiffer or softer springs of the housings move it" in critical
    k = int(np.argmin(np.abs(state.response.speed_rpm - 9000.0)))
    at_bearing = state.response.major[k, state.response.names.index("bearing 0")]
    pressed = max(float(one.approach[one.heaviest].sum()) for _, one in state.supports[0].bearings)
    assert state.ring_orbits[0] < pressed < at_bearing
    assert any("left 6205 in its outer ring by" in text for text in fan(2e-4).concerns)
    thin = SqueezeFilmDamper(length=0.006, diameter=0.07, clearance=8e-5, viscosity=0.01)
    small, large = (
        fan(1e-6, thin),
        fan(9e-5, thin),
    )  # the orbit is linear in the unbalance, beside the weight's part
    (ratio, other), (name, most) = (one[1] for one in small.eccentricities), large.eccentricities[0]
    assert ratio == pytest.approx(other, rel=1e-6) and name == "damper of left 6205"
    places = large.response.names.index("housing 0")
    orbits = [one.response.major[k, places] / 8e-5 for one in (small, large)]
    assert most - ratio == pytest.approx(orbits[1] - orbits[0], rel=1e-6) and orbits[1] > 0.3 > ratio
    said = [text for one in (small, large) for text in one.reservations if "linear dampers" in text]
    assert len(said) == 1 and f"goes to {most:.2g} in the damper of left 6205, {most:.2g} in the damper" in said[0]
