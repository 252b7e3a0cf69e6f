"""Icon of an FMU: a ball on its film above a raceway. PNG without time stamps, equal bytes at every export."""

from __future__ import annotations

import struct
import zlib
from functools import cache

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

SIZE, FINER = 128, 3  # pixels; points each way in one of them (FMI 3.0 asks for 100 pixels at least)


@cache
def icon() -> bytes:
    """``model.png`` of FMI 2.0, ``terminalsAndIcons/icon.png`` of FMI 3.0."""
    at = (np.arange(SIZE * FINER) + 0.5) / (SIZE * FINER)  # y counts from the top
    x, y = np.meshgrid(at, at)
    race = np.hypot(x - 0.5, y - 1.79) - 1.1  # distance from the raceway, < 0 within
    ball = np.hypot(x - 0.5, y - 0.36) - 0.33
    thickness, width = 0.035, 0.24
    picture = np.zeros((*x.shape, 4))
    picture[(ball < 0.0) & (race >= thickness)] = 0x8D, 0x99, 0xA6, 0xFF
    picture[(race < thickness) & (np.abs(x - 0.5) < width)] = 0xE0, 0x8A, 0x1E, 0xFF
    picture[race <= 0.0] = 0x4A, 0x55, 0x60, 0xFF
    return _png(_averaged(picture))


def _averaged(picture: _Floats) -> NDArray[np.uint8]:
    """One pixel of FINER^2 points; colours weigh as much as they cover."""
    blocks = picture.reshape(SIZE, FINER, SIZE, FINER, 4)
    cover = blocks[..., 3:].sum(axis=(1, 3))
    colour = (blocks[..., :3] * blocks[..., 3:]).sum(axis=(1, 3)) / np.maximum(cover, 1.0)
    return np.concatenate([colour, cover / FINER**2], axis=-1).round().astype(np.uint8)


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """PNG of 8 bits and four channels; rows as they are (filter 0)."""
    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, content) for name, content in parts)


def _chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
