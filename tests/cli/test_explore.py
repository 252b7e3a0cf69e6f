"""``ehlcontact explore``: what its page answers, in a browser and in node, is what Python answers; and the page."""

import json

import numpy as np
import pytest
from browsers import ENGINES

from ehlcontact import Lubricant, MoesPoint
from ehlcontact.cli.explorer import COMPUTING, script
from ehlcontact.errors import InputError
from reduced_models import Atlas, BallBearing
from reduced_models.bearing.catalogue import ROWS

CLOSE = 1e-6  # of every number: what the issue asks for
NUMBERS = ("approach", "h_central", "h_min", "film_share", "moment", "stiffness", "damping")
GRADES = (10, 22, 32, 68, 150, 460)


@pytest.fixture(scope="module")
def computing():
    return script(COMPUTING)


@pytest.fixture(scope="module", params=ENGINES)
def ask(request, computing, tmp_path_factory):
    """``ask(body, asked)``: ``body`` is a function of `atlas` and one entry; its values for all entries."""

    def run(body, asked):
        call = """
        const atlas = new Atlas(DATA.atlas);
        const one = (atlas, asked) => { BODY };
        const plain = (key, value) => (ArrayBuffer.isView(value) ? Array.from(value) : value);
        const told = asked => {
          try { return one(atlas, asked); }
          catch (error) { if (!(error instanceof InputError)) throw error; return { refused: { ...error } }; }
        };
        const answer = JSON.stringify(ASKED.map(told), plain);"""
        code = computing + call.replace("BODY", body).replace("ASKED", json.dumps(asked))
        return ENGINES[request.param](code, tmp_path_factory.mktemp("asked"))

    return run


def refused(body):
    """The refusal of a call as the page has it, or None."""
    try:
        body()
    except InputError as error:
        return {"field": error.field, "value": error.value, "allowed": error.allowed}
    return None


def inside(atlas, count, seed=14):
    """Points all over the box, half of them of other oils."""
    rng, box, points = np.random.default_rng(seed), atlas.box, []
    while len(points) < count:
        M, kappa = (np.exp(rng.uniform(*np.log(ends))) for ends in (box.M, box.kappa))
        oil = {} if len(points) % 2 else {"alpha": rng.uniform(1e-8, 4e-8), "eta0": np.exp(rng.uniform(-6.2, 0.0))}
        point = MoesPoint(M, rng.uniform(*box.L), kappa, **oil)
        if point.p_hertz <= box.p_hertz:
            points.append(point)
    return [*points[2:], MoesPoint(200.0, 0.0, 0.5), MoesPoint(box.M[0], box.L[1], box.kappa[1])]


def asked_of(point):
    return {name: getattr(point, name) for name in ("M", "L", "kappa", "alpha", "eta0")}


def test_atlas_answers_as_in_python(ask):
    atlas = Atlas()
    points = inside(atlas, 200)
    assert len(points) == 200
    found = ask("return atlas.at(asked);", [asked_of(point) for point in points])
    for point, here in zip(points, found, strict=True):
        there = atlas.at(point)
        for name in NUMBERS:
            np.testing.assert_allclose(here[name], getattr(there, name), rtol=CLOSE, atol=1e-12, err_msg=name)
            np.testing.assert_allclose(here["error"][name], there.error[name], rtol=CLOSE, err_msg=name)


def test_between_the_frequencies_of_the_table(ask):
    atlas = Atlas()
    points, Omega = inside(atlas, 40, seed=7), [0.0, 1e-4, 0.02, 0.7, 3.3, 11.3, 47.0, 60.0]
    body = """
    const { stiffness, damping, error } = atlas.at(asked.point);
    const K = atlas.over(stiffness, error.stiffness), C = atlas.over(damping, error.damping);
    return asked.Omega.map(at => [...K(at), ...C(at)]);"""
    found = ask(body, [{"point": asked_of(point), "Omega": Omega} for point in points])
    for point, here in zip(points, found, strict=True):
        there = atlas.at(point).impedance(Omega=Omega)
        columns = there.stiffness, there.error["stiffness"], there.damping, there.error["damping"]
        for column, values in zip(np.transpose(here), columns, strict=True):
            np.testing.assert_allclose(column, values, rtol=CLOSE, atol=1e-10)
