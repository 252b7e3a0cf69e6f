"""Degrees of freedom by the name of their node."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError

PLANE = ("x", "y")
DIRECTIONS = (*PLANE, "tilt_x", "tilt_y")  # of a node of a shaft: displacements [m], angles about x and y [rad]
LENGTHS = (*PLANE, "z")  # of all of them those that are displacements; the whole shaft has one along z


def flat_nodes(nodes: Mapping[str, Mapping[str, int]]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Names "disc x", "disc y", ... and the degrees of freedom that they stand for."""
    names = tuple(f"{node} {direction}" for node, at in nodes.items() for direction in at)
    return names, np.array([place for at in nodes.values() for place in at.values()], np.int64)


class NodeError(InputError, AttributeError):
    """A name that no node has; an `AttributeError` too, for `hasattr` of properties such as `disc`."""


class ByNode:
    """Base of what has `names` of degrees of freedom, as "disc x", and their `places`."""

    names: tuple[str, ...]
    places: NDArray[np.int64]

    @property
    def nodes(self) -> dict[str, dict[str, int]]:
        """Degrees of freedom by node and direction."""
        by_node: dict[str, dict[str, int]] = {}
        for name, place in zip(self.names, self.places.tolist(), strict=True):
            node, _, direction = name.rpartition(" ")
            by_node.setdefault(node, {})[direction] = place
        return by_node

    def _node(self, values: NDArray[Any], name: str) -> NDArray[Any]:
        """Motion of a node in x and y, of `values` over all degrees of freedom; 0 where it does not move."""
        nodes = self.nodes
        if not isinstance(name, str) or name not in nodes:
            known = f"one of {', '.join(nodes)}" if nodes else "none: the rotor has no names"
            raise NodeError("node", name, known)
        if nodes[name].keys().isdisjoint(PLANE):
            places = ", ".join(f"nodes[{name!r}][{key!r}] = {place}" for key, place in nodes[name].items())
            raise InputError("node", name, f"one that moves across the shaft; its degrees of freedom are {places}")
        motion = np.zeros((*values.shape[:-1], len(PLANE)), values.dtype)
        for k, direction in enumerate(PLANE):
            if direction in nodes[name]:
                motion[..., k] = values[..., nodes[name][direction]]
        motion.setflags(write=False)
        return motion
