"""Pictures as arrays, drawn by the program `gyre render`."""

import os
import tempfile
import zlib
from pathlib import Path

import numpy as np

from ._program import program, run_program
from ._scenes import Scene


def render(what, width=640, height=480, **options):
    """A picture of a world or a scene as it is: an array of height by width by 3 bytes, red, green, blue.

    Options are those of `gyre render`, with underscores: camera=(x, y, z), look_at=(x, y, z), direction=(azimuth, elevation), fov, zoom,
    follow, samples. Gases and liquids are drawn only in scenes.
    """
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "picture.png")
        if isinstance(what, Scene):
            source = os.path.join(folder, "now.gyre.json")
            Path(source).write_text(what.write(), encoding="utf-8")
        else:
            source = os.path.join(folder, "now.gyrec")
            with what.record(source, commands=False):
                pass
        command = [program("gyre.render()"), "render", source, "--out", picture, "--size", f"{width}x{height}", "--quiet"]
        for name, value in options.items():
            text = ",".join(str(float(v)) for v in np.ravel(value)) if np.ndim(value) else str(value)
            command.append(f"--{name.replace('_', '-')}={text}")
        run_program(command)
        return read_png(Path(picture).read_bytes())


def read_png(data):
    """The pixels of a picture with 8 bits a colour, without interlace (ISO/IEC 15948)."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("this is no PNG picture")
    at, packed = 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
            if body[8] != 8 or body[9] not in (2, 6) or body[12]:
                raise ValueError("expected a picture of 8 bits a colour, not interlaced")
            channels = 3 if body[9] == 2 else 4
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    out = np.zeros((height + 1, width * channels), np.uint8)  # the row above the first one is zero
    for y in range(height):
        out[y + 1] = unfilter(rows[y, 0], rows[y, 1:], out[y], channels)
    return out[1:].reshape(height, width, channels)[:, :, :3].copy()


def unfilter(kind, row, above, channels):
    """Undoes the prediction of one row of a PNG picture."""
    if kind == 0:
        return row
    if kind == 2:
        return row + above
    if kind == 1:
        return np.cumsum(row.reshape(-1, channels), axis=0, dtype=np.uint8).ravel()
    out, up = np.zeros((len(row) // channels + 1, channels), np.int32), above.reshape(-1, channels).astype(np.int32)
    row, corner = row.reshape(-1, channels).astype(np.int32), np.zeros(channels, np.int32)
    for i in range(len(row)):
        left = out[i]
        if kind == 3:
            guess = (left + up[i]) // 2
        else:
            whole = left + up[i] - corner
            far = np.abs(whole - left), np.abs(whole - up[i]), np.abs(whole - corner)
            guess = np.where((far[0] <= far[1]) & (far[0] <= far[2]), left, np.where(far[1] <= far[2], up[i], corner))
        out[i + 1], corner = (row[i] + guess) & 255, up[i]
    return out[1:].astype(np.uint8).ravel()
