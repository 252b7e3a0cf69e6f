"""Assumptions about oil and gap: isothermal, Newtonian, smooth, fully flooded."""

from __future__ import annotations

from math import e

from ehlcontact.assumptions.contact import BY_FORMULA, NO_SI, Contact
from ehlcontact.assumptions.table import Assumption
from ehlcontact.film_formulas import flooding_distance, gupta_heating, starved_film, wilson_heating
from ehlcontact.hertz import shape_factor
from ehlcontact.lubricant.traction_laws import LARGEST_SLIDE_ROLL
from ehlcontact.solver.domain import Domain

LEAST_HEATING_FACTOR = 0.9  # a film a tenth too thick: what the tolerance of an oil's grade leaves open anyway
EYRING_STRESS = 5e6  # Pa, mineral oils, 2 to 10; Johnson and Tevaarwerk, Proc. R. Soc. A 356 (1977) 215-236
# At the Eyring stress the flow under pressure is a tenth above Newton's, 3 (x cosh x - sinh x)/x^3 (Conry, Wang
# and Cusano, J. Tribology 109 (1987) 648-654); the film is then 3 % thinner (Grubin's inlet, docs/assumptions.md).
LARGEST_STRESS = 1.0
# Time in contact, none above the first and all of it below the other: Tallian, ASLE Trans. 10 (1967) 418-439
LEAST_LAMBDA, MIXED_LAMBDA = 3.0, 1.0
SMOOTH_SCATTER = "on the safe side: the contact flattens long waves of a roughness measured outside it"
FORMULA_SCATTER = (
    "; Hamrock and Dowson's smallest film is 12 % below to 59 % above that of the atlas in nine of ten contacts, "
    "and up to three times as high in heavily loaded circles: film= takes a better one"
)


def isothermal(contact: Contact, slope: float, conductivity: float, solved: float | None = None) -> Assumption:
    """What shear in the inlet heats, and the film loses by it; `solved` is the share left of a film with heat."""
    value, verdict = None, NO_SI
    details = {"temperature_slope": slope, "conductivity": conductivity}
    if contact.scales is not None:
        s, _, modulus, u = contact.require_si()
        load = slope * contact.moes.eta0 * u * u / conductivity
        value, other = gupta_heating(load, s.pressure / modulus), wilson_heating(load)
        details |= {"thermal_load": load, "wilson": other}
        verdict = (
            f"shear heats the inlet: film {_percent(1.0 - value)} thinner, "
            f"{_percent(1.0 - other)} by Wilson and Sheu"
        )
    if solved is not None and value is not None:
        verdict = (
            f"not assumed: solved with heat, film {_percent(1.0 - solved)} thinner in the centre; "
            f"{_percent(1.0 - value)} by Gupta et al., {_percent(1.0 - other)} by Wilson and Sheu"
        )
        details |= {"solved": solved, "gupta": value}
        value = None
    return Assumption(
        name="isothermal",
        number="inlet shear heating factor phi_T, film over isothermal film",
        value=value,
        limit=LEAST_HEATING_FACTOR,
        at_least=True,
        unit="-",
        verdict=verdict,
        scatter="published formulas differ by up to half of 1 - phi_T; the oil's data add a tenth of it",
        source="Gupta et al. 1992; Wilson and Sheu 1983; Greenwood and Kauzlarich 1973",
        details=details,
    )


def newtonian(contact: Contact) -> Assumption:
    """Shear stress where the film is made, and the sliding at which it thins the oil.

    In pure rolling the only shear is that of the flow under pressure, 6 eta u (h - h*)/h^2 at the wall, at most
    1.5 eta u/h* where h = 2 h*; the film is made where alpha p is about 1, so at e times the ambient viscosity.
    """
    value, verdict, details = None, NO_SI, {"eyring_stress": EYRING_STRESS}
    if contact.scales is not None:
        s, _, _, u = contact.require_si()
        rise = e if contact.moes.L > 0.0 else 1.0
        stress = 1.5 * rise * contact.moes.eta0 * u / (contact.central * s.length)
        value = stress / EYRING_STRESS
        sliding = 1.5 / value  # where eta (u1 - u2)/h* is the Eyring stress, over the mean speed
        details |= {"stress": stress, "slide_roll_limit": sliding}
        thinned = f"a slide-roll ratio above {sliding:.2g}" if sliding < LARGEST_SLIDE_ROLL else "no sliding"
        verdict = (
            f"rolling shears the inlet by {stress * 1e-6:.2g} MPa; {thinned} would thin the film; "
            "traction is another matter (docs/traction.md)"
        )
    return Assumption(
        name="newtonian",
        number="largest shear stress of the inlet in pure rolling over the Eyring stress",
        value=value,
        limit=LARGEST_STRESS,
        at_least=False,
        unit="-",
        verdict=verdict,
        scatter="a factor of 2, as the Eyring stress of mineral oils, 2 to 10 MPa; polymers thin earlier",
        source="Johnson and Tevaarwerk 1977; Conry, Wang and Cusano 1987",
        details=details,
    )


def smooth(contact: Contact, roughness: float | None) -> Assumption:
    """Smallest film against the composite roughness [m]."""
    value, verdict, details = None, NO_SI, {}
    if contact.scales is not None and contact.smallest is not None:
        film = contact.smallest * contact.scales.length
        details = {"h_min": film, "largest_roughness": film / LEAST_LAMBDA}
        verdict = f"not judged: no roughness given; holds up to a composite Rq of {_um(film / LEAST_LAMBDA)}"
        verdict += f" ({contact.origin})"
        if roughness is not None:
            value, details["roughness"] = film / roughness, roughness
            verdict = f"smallest film {_um(film)} ({contact.origin}) over a roughness of {_um(roughness)}: "
            verdict += _regime(value)
    return Assumption(
        name="smooth",
        number="lambda ratio, smallest film over composite roughness (Rq1^2 + Rq2^2)^(1/2)",
        value=value,
        limit=LEAST_LAMBDA,
        at_least=True,
        unit="-",
        verdict=verdict,
        scatter=SMOOTH_SCATTER + (FORMULA_SCATTER if contact.origin == BY_FORMULA else ""),
        source="Tallian 1967",
        details=details,
    )


def fully_flooded(contact: Contact, domain: Domain | None) -> Assumption:
    """How far ahead of the contact oil has to stand, and whether that is computed."""
    needed = flooding_distance(contact.central / (2.0 * shape_factor(contact.moes.kappa)))
    value, details = None, {"m_star": needed}
    wanted = f"oil has to fill the gap from X = {-needed:.3g} on"
    if contact.scales is not None:
        details["distance"] = (needed - 1.0) * contact.scales.a
        wanted += f", {details['distance'] * 1e3:.2g} mm ahead of the Hertz ellipse"
    verdict = f"not judged: no computed region given; {wanted}"
    if domain is not None:
        value = -domain.x_in
        details["starved_film"] = starved = starved_film(value, needed)
        short = f", a film {_percent(1.0 - starved)} below the flooded one" if value < needed else ""
        verdict = f"computed from X = {domain.x_in:g} on{short}; in the bearing {wanted}"
    return Assumption(
        name="fully flooded",
        number="edge of the computed oil against the starvation boundary m*",
        value=value,
        limit=needed,
        at_least=True,
        unit="semi-axes a from the centre",
        verdict=verdict,
        scatter="starved films solved here are within 5 % of the formula; at m* they are 3 to 6 % thinner",
        source="Hamrock and Dowson 1977, part IV",
        details=details,
    )


def _regime(ratio: float) -> str:
    if ratio >= LEAST_LAMBDA:
        return "a full film"
    return "mixed, asperities touch" if ratio >= MIXED_LAMBDA else "boundary, asperities touch all the time"


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %" if share < 0.1 else f"{100.0 * share:.0f} %"


def _um(length: float) -> str:
    return f"{length * 1e6:.2g} µm"
