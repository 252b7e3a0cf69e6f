"""K and C of contacts with heat under a layer of oil, solved, beside products of both (docs/notes/heat.md).

python docs/site/starved_heat_impedance.py
"""

from heat import ball

from ehlcontact import Domain, Grid, Heat, Lubricant, OilLayer, impedance

GRID = Grid(192, Domain(-6.0, 1.5, 3.0))
CONTACTS = [  # bearing, its load [N], rev/min; the most loaded ball at the inner race
    ("6205", 1000.0, 3000.0),
    ("6205", 1000.0, 10_000.0),
    ("6305", 2000.0, 3000.0),
    ("6305", 2000.0, 10_000.0),
    ("6202", 500.0, 15_000.0),
]
LAYERS = 0.6, 1.0, 1.5
OIL = Lubricant.iso_vg(68, temperature=50.0)


def row(bearing, load, rpm):
    """K [N/um] and C [N s/m] at the frequency of the shaft and at 1000 Hz: solved with both, and products."""
    point, hz = ball(bearing, OIL, rpm, load), [rpm / 60.0, 1000.0]

    def solved(r=None, thermal=None):
        layer = None if r is None else OilLayer(over_flooded=r)
        return impedance(point, hz=hz, grid=GRID, supply=layer, thermal=thermal)

    def ratio(one, other):
        return one.stiffness / other.stiffness, one.damping / other.damping

    cold, warm = solved(), solved(thermal=Heat())
    share = warm.film.temperature.film_share
    print(f"{bearing} {rpm:g} rev/min, heat leaves {share:.3f} of the film")
    print("  C flooded", cold.damping, "with heat", warm.damping)
    for r in LAYERS:
        layer, more, both = solved(r), solved(r / share), solved(r, Heat())
        bar = both.error_bars["damping"]
        print(f"  r = {r:g}: K {both.stiffness * 1e-6}, C {both.damping} +- {bar}, layer {layer.damping}")
        for name, product in ("C(r)", layer), ("C(r/T)", more):
            by_k, by_c = ratio(product, cold)
            k, c = warm.stiffness * by_k / both.stiffness, warm.damping * by_c
            print(f"    product with {name}: K over it {k}, C {c}, off by {c - both.damping}", flush=True)


def main():
    """All contacts."""
    for contact in CONTACTS:
        row(*contact)


if __name__ == "__main__":
    main()
