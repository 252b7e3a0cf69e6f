"""What the package promises as a whole."""

import reduced_models


def test_public_names_are_there():
    for name in (
        "ContactRecord", "fit", "fit_memory", "sensitivity", "FitResult", "MemoryFit", "ElementFit",
        "LinearContact", "CubicContact", "PolynomialContact", "PowerLawContact", "FilmMemoryContact",
        "WideRangeContact", "wide_range_contact", "wide_range_from_solves",
        "ContactElement", "OutsideValidityWarning",
        "JeffcottRotor", "ContactMount", "RotorState", "RotorResult", "LinearBearing", "simulate_rotor", "compare",
        "simulate_oscillator", "ScaledContact", "BallBearing", "BearingState", "BearingCoefficients",
        "BearingMotion", "DefectFrequencies", "Rotor", "BearingMount", "Unbalance", "SpeedProfile",
        "rotor_on_bearings", "Shaft", "Disc", "Support",
        "from_ross", "RossCallback",
        "simulate_rotor", "RotorResult", "linearise", "LinearRotor", "RotorMode", "campbell", "Campbell",
        "CriticalSpeed", "unbalance_response", "rotor_to_control", "UnbalanceResponse",
        "Atlas", "AtlasAnswer",
    ):  # fmt: skip
        assert hasattr(reduced_models, name)
