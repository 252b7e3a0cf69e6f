"""Every number of a report and of its results, computed a second time from the study and the stored histories."""

import importlib.metadata
import json
import platform

import numpy as np
import pytest
from page_numbers import PageNumbers
from recomputed import MODELS, POWERS, RECORDS, Recomputed, shape

STUDY = """
[bearing]
balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
conformity = 0.52
radial_load = 20.0
speed_rpm = 3000.0
[oil]
eta0 = 0.02
alpha = 1e-8
[surface]
rq_ball_um = 0.02
rq_race_um = 0.15
[solver]
n = 48
n_transient = 32
[free]
steps_per_period = 20
[harmonic]
steps_per_period = 20
[rotor]
arrangement = "vee"
disc_mass = 1.0
journal_mass = 0.1
shaft_stiffness = 5e5
unbalance = 8e-6
revolutions = 1
steps_per_revolution = 20
fit_steps_per_period = 20
fit_amplitude = 0.1
"""
TITLES = {
    "free": "free vibration",
    "harmonic": "harmonic, contact band",
    "rotor_band": "harmonic, rotor band",
    "memory": "all bands, with film memory",
}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A study file and the folder of its finished run: two grids, two balls, a rough race."""
    from ehlcontact.cli import main

    root = tmp_path_factory.mktemp("report")
    file = root / "study.toml"
    file.write_text(STUDY)
    with pytest.raises(SystemExit) as stop:
        main(["run", str(file), "-o", str(root / "out")])
    assert not stop.value.code
    return file, root / "out"


@pytest.fixture(scope="module")
def again(finished):
    return Recomputed(*finished)


@pytest.fixture(scope="module")
def results(finished):
    return json.loads((finished[1] / "results.json").read_text())


@pytest.fixture(scope="module")
def refused(results):
    """Why a record and a model have no element, by both; the damper of such a fit is negative."""
    return {(row["record"], row["model"]): row["refused"] for row in results["fits"] if "refused" in row}


def test_operating_point_in_the_results(again, results):
    for name, value in results["operating_point"].items():
        assert value == pytest.approx(getattr(again.point, name), rel=1e-9), name


@pytest.mark.parametrize("record", RECORDS)
@pytest.mark.parametrize("model", MODELS)
def test_fits_in_the_results(again, results, refused, record, model):
    ours = again.fit(record, model)
    if (record, model) in refused:
        assert ours.parameters["C1"] < 0.0
        return
    (row,) = (row for row in results["fits"] if (row["record"], row["model"]) == (record, model))
    for name, value in ours.parameters.items():
        assert row["parameters"][name] == pytest.approx(value, rel=1e-6)
        assert row["si"][name] == pytest.approx(value * again.units.of[name], rel=1e-6)
        assert row["std_errors"][name] == pytest.approx(ours.errors[name], rel=1e-4)
        assert row["intervals"][name] == pytest.approx(ours.intervals[name], rel=1e-4)
    for name in ("rms", "root", "tangent"):
        assert row[name] == pytest.approx(getattr(ours, name), rel=1e-6)
    assert row["e_f"] == pytest.approx(ours.e_f, abs=1e-9)
    assert row["independent_samples"] == pytest.approx(ours.independent, rel=1e-4)
    valid = row["valid"]
    assert (valid["low"], valid["high"], valid["rate"]) == (ours.low, ours.high, ours.rate)
    assert tuple(valid["load"]) == ours.load


def test_work_of_a_cycle_in_the_results(again, results):
    assert results["cycle_work"] == pytest.approx(again.work, rel=1e-6)


def test_memory_in_the_results(again, results):
    found, data = results["memory"], results["memory"]["impedance"]
    K, C = again.memory_impedance(data["omega"])
    assert found["stiffness_error_max"] == pytest.approx(np.abs(K / data["stiffness"] - 1.0).max(), rel=1e-4)
    assert found["damping_error_max"] == pytest.approx(np.abs(C / data["damping"] - 1.0).max(), rel=1e-4)
    assert found["record_rms"] == pytest.approx([again.memory_rms(name) for name in RECORDS], rel=1e-6)


def test_films_and_records_in_the_results(again, results):
    film, found = again.steady, results["steady"]
    assert found["p_max"] == film.P.max() and found["cycles"] == film.residuals.size - 1
    assert found["h_min"] <= film.H.min() and film.H.min() < 1.02 * found["h_min"]
    assert found["residual"] == film.residuals[-1] / film.dry_residual
    for name, run in again.records.items():
        row = results["simulations"][name]
        assert row["static_approach"] == run.static_approach and row["steps"] == run.T.size - 1
        assert row["force_range"] == [run.force.min(), run.force.max()]
        assert row["largest_load_residual"] == np.abs(run.load_residuals).max()


def claim_operating_point(page, again):
    p, film, coarse, solver = again.point, again.steady, again.records["rotor_band"], again.study["solver"]
    page.claim("bearing load | # N", p.radial_load)
    page.claim("load of the most loaded ball | # N", p.load)
    page.claim("speed | # rpm", p.speed_rpm)
    page.claim("= u1 + u2 | # m/s", p.u_sum)
    page.claim("η0 | # Pa s", p.eta0)
    page.claim("α | # 1/Pa", p.alpha)
    page.claim("Moes M | #", p.M)
    page.claim("Moes L | #", p.L)
    page.claim("κ = a/b | #", p.kappa)
    page.claim("Hertz pressure ph | # GPa", p.p_hertz * 1e-9)
    page.claim("semi-axes a, b | #, # mm", p.a * 1e3, p.b * 1e3)
    page.claim("dry approach δH | # um", p.dry_approach * 1e6)
    page.claim("time unit 2a/usum | # us", p.time_unit * 1e6)
    page.claim("approach u | # = # um", film.approach, p.approach_m * 1e6)
    page.claim("central film hc | # um", p.h_central_um)
    page.claim("minimum film hmin | # um", p.h_min_um)
    page.claim("largest pressure | # GPa", film.P.max() * p.p_hertz * 1e-9)
    page.claim("rotor's Omega = omega 2a/usum | #", p.rotor_omega)
    page.claim("Steady film on n = # intervals", solver["n"])
    page.claim("transient films on n = #", solver["n_transient"])
    page.claim("computed region # <= X <= #, |Y| <= #", film.X[0], film.X[-1], film.Y[-1])
    there, here = coarse.h_central[0] * p.dry_approach * 1e6, p.h_central_um
    page.claim(
        "an approach of # and a central film of # um where the finer one gives # and # um",
        *(coarse.static_approach, there, film.approach, here),
    )


def claim_assumptions(page, again, results):
    """Values, limits and verdicts by the formulas of docs/assumptions.md; constants of the literature as such."""
    p, u = again.point, 0.5 * again.point.u_sum
    slope, film = 0.0112 * np.log(p.eta0 / 860.0 * 1e6 + 0.7), p.h_central_um * 1e-6
    heat = slope * p.eta0 * u * u / 0.134
    factor = (1.0 - 13.2 * p.p_hertz / p.modulus * heat**0.42) / (1.0 + 0.213 * heat**0.64)
    wilson = 1.0 / (1.0 + 0.1 * (4.0 * heat) ** 0.64)
    stress = 1.5 * np.e * p.eta0 * u / film
    rough = np.hypot(*(again.study["surface"][name] * 1e-6 for name in ("rq_ball_um", "rq_race_um")))
    flooded = 1.0 + 3.06 * (again.steady.h_central / (2.0 * shape(p.kappa))) ** 0.58
    shaken = np.hypot(*again.rotor_full.journal_velocity.T).max()
    least = p.h_min_um * 1e-6
    for sure in (f"{row['name']} - {row['scatter']} ({row['source']})" for row in results["assumptions"]["table"]):
        page.claim(sure)
    page.claim("isothermal | # | >= # | yes", factor, 0.9)
    page.claim("takes # % off the film, # % by Wilson and Sheu", 100.0 * (1.0 - factor), 100.0 * (1.0 - wilson))
    page.claim("newtonian | # | <= # | yes", stress / 5e6, 1.0)
    page.claim("shears the inlet by # MPa; no sliding", stress * 1e-6)
    page.claim("smooth | # | >= # | NO", least / rough, 3.0)
    page.claim("(Rq1^2 + Rq2^2)^(1/2)")
    for end in (": mixed, asperities touch.",):
        page.claim(f"smallest film # um over a roughness of # um{end}", least * 1e6, rough * 1e6)
    page.claim("fully flooded | # | >= # | yes", -again.steady.X[0], flooded)
    page.claim(
        "computed from X = # on; in the bearing oil has to fill the gap from X = # on, # mm ahead",
        *(again.steady.X[0], -flooded, (flooded - 1.0) * p.a * 1e3),
    )
    page.claim("constant speed | # | <= # | yes", shaken / u, 0.01 / 0.67)
    page.claim(
        "adds up to # m/s to # m/s; # m/s of change change the film by 1 %, within the # us",
        *(shaken, u, 0.01 / 0.67 * u, 2.0 * p.time_unit * 1e6),
    )
    page.claim("one direction | # | <= # | yes", shaken / u, 0.1)
    page.claim("adds up to # m/s to # m/s; holds up to # m/s across", shaken, u, 0.1 * u)
    page.claim("elastic | # | <= # | yes", p.p_hertz, 4.2e9)
    page.claim("# GPa, below the 1.5 GPa where bearing steel begins to tire", p.p_hertz * 1e-9)


def claim_captions(page, again):
    p, free, harmonic = again.point, again.records["free"].motion, again.records["harmonic"].motion
    mass = p.load * p.time_unit**2 / p.dry_approach / free["omega_n"] ** 2
    hertz = harmonic["omega"] / p.time_unit / (2.0 * np.pi)
    page.claim("full multigrid: # cycles in # s", again.steady.residuals.size - 1, again.steady.seconds)
    page.claim("Free vibration at Omega_n = #, a mass of # g", free["omega_n"], mass * 1e3)
    page.claim("Harmonic load at Omega = # (# kHz)", harmonic["omega"], hertz * 1e-3)


def claim_fits(page, again, refused):
    for record in RECORDS:
        for model in MODELS:
            if (record, model) in refused:
                page.claim(f"{TITLES[record]} | {model} | no element: {refused[record, model]}")
                continue
            found = again.fit(record, model)
            own = [found.parameters.get(name) for name in POWERS]
            page.claim(
                f"{TITLES[record]} | {model} | # | # | # | # | # | # | # % | # .. #",
                *(*own, found.root, found.tangent, 100.0 * found.rms, found.low, found.high),
            )
            si = {name: value * again.units.of[name] for name, value in found.parameters.items()}
            tangent = found.tangent * again.units.stiffness * 1e-6
            page.claim(
                f"{TITLES[record]} | {model} | # | # | # | # | #", *(si.get(name) for name in POWERS), tangent
            )


def claim_memory_and_work(page, again, results):
    data = results["memory"]["impedance"]
    K, C = again.memory_impedance(data["omega"])
    page.claim("K within # %", 100.0 * np.abs(K / data["stiffness"] - 1.0).max())
    page.claim("C within # %", 100.0 * np.abs(C / data["damping"] - 1.0).max())
    page.claim("force within # %, # %, # % (rms", *(100.0 * again.memory_rms(r) for r in RECORDS))
    work = {name: value * 1e6 for name, value in again.work.items()}
    page.claim("in one cycle at the rotor's frequency, # uJ", work["full"])
    page.claim("the cubic fitted there gives # uJ", work["rotor_band"])
    page.claim("the film memory # uJ", work["memory"])
    page.claim("the cubic fitted in the contact's own band # uJ", work["harmonic"])


def claim_fmu(page, folder):
    from fmu import verify
    from reduced_models import load_element

    found = verify(folder / "contact.fmu", load_element(folder / "elements" / "rotor_band_cubic_si.json"))
    page.claim("(FMI 2.0 co-simulation")
    page.claim("# findings of fmpy's validation", len(found.findings))
    page.claim("force within # (relative) of the Python element over # states", found.force, found.states)


def claim_origin(page, results):
    made = {"ehlcontact": results["versions"]["ehlcontact"], "python": platform.python_version()}
    made |= {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba", "fmpy", "h5py")}
    for name, version in made.items():
        page.claim(f"{name} {version},")
    for name, seconds in results["seconds"].items():
        page.claim(f"{name} # s", seconds)


def test_every_number_of_the_page(finished, again, results, refused):
    _, _, rest = (finished[1] / "report.html").read_text().partition("<h2>Operating point")
    text, _, rest = rest.partition("<h2>Rotor")
    page = PageNumbers("<h2>Operating point" + text + rest[rest.index("<h2>Made") :])
    claim_operating_point(page, again)
    claim_assumptions(page, again, results)
    claim_captions(page, again)
    claim_fits(page, again, refused)
    claim_memory_and_work(page, again, results)
    claim_fmu(page, finished[1])
    claim_origin(page, results)
    page.claim("2a/usum. Root: approach")
    assert page.left == [], "\n".join(page.left)
