"""Who knows which number of a report: the contact's part, from `report.contact`."""

import importlib.metadata
import platform

import fmpy
import numpy as np
from plotly.offline import get_plotlyjs_version

from report.contact import MODELS, POWERS, RECORDS, shape

TITLES = {
    "free": "free vibration",
    "harmonic": "harmonic, contact band",
    "rotor_band": "harmonic, rotor band",
}


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
    page.claim("approach u | # ± # = # um", film.approach, p.approach_error, p.approach_m * 1e6)
    page.claim("central film hc | # um ± # % of it", p.h_central_um, 100.0 * p.h_central_error)
    page.claim("minimum film hmin | # um ± # % of it", p.h_min_um, 100.0 * p.h_min_error)
    page.claim("largest pressure | # GPa", film.P.max() * p.p_hertz * 1e-9)
    page.claim("rotor's Omega = omega 2a/usum | #", p.rotor_omega)
    page.claim("Steady film on n = # intervals", solver["n"])
    page.claim("transient films on n = #", solver["n_transient"])
    page.claim("computed region # <= X <= #, |Y| <= #", film.X[0], film.X[-1], film.Y[-1])
    if solver["n"] == solver["n_transient"]:
        return
    there, here = coarse.h_central[0] * p.dry_approach * 1e6, p.h_central_um
    page.claim(
        "an approach of # and a central film of # um where that of the steady film gives # and # um",
        *(coarse.static_approach, there, film.approach, here),
    )


def claim_assumptions(page, again, rotor, results):
    """Values, limits and verdicts by the formulas of docs/assumptions.md; constants of the literature as such."""
    p, u = again.point, 0.5 * again.point.u_sum
    slope, film = 0.0112 * np.log(p.eta0 / 860.0 * 1e6 + 0.7), p.h_central_um * 1e-6
    heat = slope * p.eta0 * u * u / 0.134
    factor = (1.0 - 13.2 * p.p_hertz / p.modulus * heat**0.42) / (1.0 + 0.213 * heat**0.64)
    wilson = 1.0 / (1.0 + 0.1 * (4.0 * heat) ** 0.64)
    stress = 1.5 * np.e * p.eta0 * u / film
    rough = np.hypot(*(again.study["surface"][name] * 1e-6 for name in ("rq_ball_um", "rq_race_um")))
    flooded = 1.0 + 3.06 * (again.steady.h_central / (2.0 * shape(p.kappa))) ** 0.58
    shaken = max(np.hypot(*rotor.stored[name].journal_velocity.T).max() for name in ("rotor_full", "decay"))
    least = p.h_min_um * 1e-6
    for sure in (f"{row['name']} - {row['scatter']} ({row['source']})" for row in results["assumptions"]["table"]):
        page.claim(sure)
    page.claim("isothermal | # | >= # | yes", factor, 0.9)
    page.claim("takes # % off the film, # % by Wilson and Sheu", 100.0 * (1.0 - factor), 100.0 * (1.0 - wilson))
    page.claim("newtonian | # | <= # | yes", stress / 5e6, 1.0)
    page.claim("shears the inlet by # MPa; no sliding", stress * 1e-6)
    page.claim("smooth | # | >= # | NO", least / rough, 3.0)
    page.claim("(Rq1^2 + Rq2^2)^(1/2)")
    for end in (": mixed, asperities touch.", ": mixed, asperities touch)."):  # in the table, and in the headline
        page.claim(
            f"smallest film # um (solved, ± # %) over a roughness of # um{end}",
            *(least * 1e6, 100.0 * p.h_min_error, rough * 1e6),
        )
    page.claim("fully flooded | # | >= # | yes", -again.steady.X[0], flooded)
    page.claim(
        "computed from X = # on; in the bearing oil has to fill the gap from X = # on, # mm ahead",
        *(again.steady.X[0], -flooded, (flooded - 1.0) * p.a * 1e3),
    )
    page.claim("constant speed | # | <= # | yes", shaken / u, 0.01 / 0.67)
    page.claim(
        "adds up to # m/s to # m/s; "
        "a change of # m/s within the # us that the film takes to cross makes 1 % of film",
        *(shaken, u, 0.01 / 0.67 * u, 2.0 * p.time_unit * 1e6),
    )
    page.claim("one direction | # | <= # | yes", shaken / u, 0.1)
    page.claim("adds up to # m/s to # m/s; holds up to # m/s across", shaken, u, 0.1 * u)
    page.claim("elastic | # | <= # | yes", p.p_hertz, 4.2e9)
    page.claim("# GPa, below the 1.5 GPa where bearing steel begins to tire", p.p_hertz * 1e-9)


def claim_captions(page, again, rotor):
    p, free, harmonic = again.point, again.records["free"].motion, again.records["harmonic"].motion
    mass = p.load * p.time_unit**2 / p.dry_approach / free["Omega_n"] ** 2
    x, y = np.unravel_index(again.steady.H.argmin(), again.steady.H.shape)
    page.claim("lowest node of the film is at X = #, |Y| = # semi", again.steady.X[x], again.steady.Y[y])
    hertz = harmonic["Omega"] / p.time_unit / (2.0 * np.pi)
    page.claim("full multigrid: # cycles in # s", again.steady.residuals.size - 1, again.steady.seconds)
    page.claim("Free vibration at Omega_n = #, a mass of # g", free["Omega_n"], mass * 1e3)
    page.claim("Harmonic load at Omega = # (# kHz)", harmonic["Omega"], hertz * 1e-3)
    found, inside, run = again.fit("rotor_band", "cubic"), again.window("rotor_band"), again.records["rotor_band"]
    pushes = 100.0 * found.parameters["C1"] * np.abs(run.rate[inside]).max()
    misses = 100.0 * found.rms * run.force[inside].std()
    page.claim("pushes with # % of the load at most, and the cubic misses the force by # %", pushes, misses)
    dampers = [rotor.impedance("full", omega)[1] for omega in (2.0 * np.pi * rotor.hz, rotor.mode("full").omega)]
    dampers.append(again.fit("harmonic", "cubic").parameters["C1"] * again.units.damping)
    page.claim("Damping is # N s/m at the speed, # at the mode, and # in the cubic", *dampers)


def claim_fits(page, again, refused):
    page.claim("95 % of C1")
    page.claim("2a/usum. Root: approach")
    for record in RECORDS:
        for model in MODELS:
            if (record, model) in refused:
                page.claim(f"{TITLES[record]} | {model} | no element: {refused[record, model]}")
                continue
            found = again.fit(record, model)
            own = [found.parameters.get(name) for name in POWERS]
            page.claim(
                f"{TITLES[record]} | {model} | # | # | # | # | # .. # | # | # | # % | # .. #",
                *(*own, *found.intervals["C1"], found.root, found.tangent),
                *(100.0 * found.rms, found.low, found.high),
            )
            si = {name: value * again.units.of[name] for name, value in found.parameters.items()}
            tangent = found.tangent * again.units.stiffness * 1e-6
            page.claim(
                f"{TITLES[record]} | {model} | # | # | # | # | #", *(si.get(name) for name in POWERS), tangent
            )


def claim_memory_and_work(page, again, results):
    data = results["memory"]["impedance"]
    K, C = again.memory_impedance(data["Omega"])
    errors = (100.0 * np.abs(ours / data[name] - 1.0).max() for ours, name in ((K, "stiffness"), (C, "damping")))
    page.claim("K within # % and C within # % of the film's", *errors)
    page.claim("force within # %, # %, # % (rms", *(100.0 * again.memory_rms(r) for r in RECORDS))
    work = {name: value * 1e6 for name, value in again.work.items()}
    page.claim("in one cycle at the rotor's frequency, # uJ", work["full"])
    page.claim("the cubic fitted there gives # uJ", work["rotor_band"])
    page.claim("the film memory # uJ", work["memory"])
    page.claim("the cubic fitted in the contact's own band # uJ", work["harmonic"])


def claim_fmus(page, folder):
    """Each FMU against its element file, without the page's own code for the steps."""
    from fmu import verify
    from reduced_models import load_element

    page.claim("FMUs of elements in SI, FMI 2.0, for co-simulation")
    steps, whys = {"held": [], "extrapolated": [], "default": []}, []
    for name, stored in (("contact.fmu", "rotor_band_cubic_si"), ("contact_film.fmu", "memory_si")):
        element = load_element(folder / "elements" / f"{stored}.json")
        found = verify(folder / name, element)
        band = sorted({w / (2.0 * np.pi) for w in element.omega_range})
        told = " to ".join("#" * len(band))
        sizes = (element.state_count, len(found.findings), found.force, found.states)
        page.claim(f"{name} | {element.kind} | {told} Hz | # | # | # | # states", *band, *sizes)
        load = element._static_load(None)
        K = element.spring_tangent(element.approach_at(load))
        slow = 0.1 / element.time
        C = element.impedance(omega=[slow], load=load)[0].imag / slow
        steps["held"].append(C / K)
        steps["extrapolated"].append(100.0 * C / K)
        steps["default"].append(fmpy.read_model_description(str(folder / name)).defaultExperiment.stepSize)
        whys += [K, C]
    page.claim("default step | # s | # s | resolves", *map(float, steps["default"]))
    late = "a force one step h late takes K h off the damping C; K = #, C = #"
    page.claim(f"largest step, inputs held | # s | # s | {late}; K = #, C = #", *steps["held"], *whys)
    page.claim("largest step, inputs extrapolated | # s | # s | where K h (w h)^#", *steps["extrapolated"], 2)
    page.claim(
        "is C, twice the damping then, at w h = # of the fastest motion w; it goes like (w h)^-2",
        0.1,
    )
    page.claim("input_meaning 2 (end) is for rollback")


def claim_origin(page, results):
    made = {"ehlcontact": results["versions"]["ehlcontact"], "python": platform.python_version()}
    made |= {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba", "fmpy", "h5py")}
    for name, version in made.items():
        page.claim(f"{name} {version},")
    page.claim(f"plotly.js {get_plotlyjs_version()}, MIT licence")
    for name, seconds in results["seconds"].items():
        page.claim(f"{name} # s", seconds)
