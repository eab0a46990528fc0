# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures as files of PNG, without another package."""

from __future__ import annotations

import struct
import zlib

import numpy
from numpy.typing import NDArray

SIGNATURE = b"\x89PNG\r\n\x1a\n"
BITS, COLORS = 8, 2  # a channel; RGB
LEVEL = 6  # of the compression, zlib's default


def png_of(rgb: NDArray[numpy.uint8]) -> bytes:
    """The PNG of a picture, height x width x 3."""
    height, width, channels = rgb.shape
    rows = numpy.zeros((height, 1 + width * channels), dtype=numpy.uint8)  # the first byte: no filter
    rows[:, 1:] = rgb.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, BITS, COLORS, 0, 0, 0)
    parts = {b"IHDR": header, b"IDAT": zlib.compress(rows.tobytes(), LEVEL), b"IEND": b""}
    return SIGNATURE + b"".join(_chunk(kind, data) for kind, data in parts.items())


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
