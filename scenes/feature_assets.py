# SPDX-License-Identifier: MIT
"""The images of the feature scenes, which scenes/features/generate writes."""
import math
import struct
import zlib


def png(width, height, texel):
    """Returns an 8-bit PNG file; texel(x, y) -> RGB or RGBA in 0..255, top row first."""
    kind = {3: 2, 4: 6}[len(texel(0, 0))]
    rows = b"".join(
        b"\0" + bytes(v for x in range(width) for v in texel(x, y)) for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def checker(x, y):
    """Returns a texel of 8 x 8 squares. Two marked corners make flips and rotations visible."""
    if x < 16 and y < 16:
        return (200, 40, 40)  # top left
    if x >= 48 and y < 16:
        return (40, 90, 200)  # top right
    return (215, 210, 200) if (x // 8 + y // 8) % 2 == 0 else (70, 72, 80)


def leaf(x, y):
    """Returns a texel of a leaf with a soft edge, whose veins are half transparent."""
    u, v = (x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1
    inside = 0.6 * math.sqrt(max(0.0, 1 - v * v)) * (1 - 0.3 * v) - abs(u)
    alpha = min(max(8 * inside, 0.0), 1.0)
    if abs(u) < 0.04 or (x + y) % 16 == 0:
        alpha *= 0.5
    return (60 + 2 * y // 3, 130 - y // 2, 40, int(255 * alpha + 0.5))


def bump(x, y):
    """Returns the height of round bumps, 8 in a row, at texel coordinates of an image of 64 x 64
    that repeats."""
    s, t = (x / 8) % 1 - 0.5, (y / 8) % 1 - 0.5
    return max(0.0, 1 - 5 * (s * s + t * t))


def heights(x, y):
    """Returns the texel of a map of heights."""
    return (int(255 * bump(x + 0.5, y + 0.5) + 0.5),) * 3


def normals(x, y):
    """Returns the texel of a map of normals of bumps that are a third as high as wide."""
    along_x = 2.5 * (bump(x + 1, y + 0.5) - bump(x, y + 0.5))
    along_y = 2.5 * (bump(x + 0.5, y) - bump(x + 0.5, y + 1))  # y grows downwards
    length = math.sqrt(along_x * along_x + along_y * along_y + 1)
    return tuple(
        int(127.5 * (c / length + 1) + 0.5) for c in (-along_x, -along_y, 1.0))


def rgbe(width, height, radiance):
    """Returns a Radiance file (flat RGBE); radiance(u, v) -> RGB, with v from the top."""
    data = bytearray()
    for y in range(height):
        for x in range(width):
            rgb = radiance((x + 0.5) / width, (y + 0.5) / height)
            mantissa, exponent = math.frexp(max(rgb))
            scale = mantissa * 256.0 / max(rgb) if max(rgb) > 0 else 0.0
            data += bytes([int(c * scale) for c in rgb] + [exponent + 128 if max(rgb) > 0 else 0])
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + bytes(data)


def sky(u, v):
    """Returns the radiance of a bluish gradient with two softboxes and dark ground.

    One softbox is broad and warm, the other is cool. The sky is bright enough for a picture and
    has no very bright pixel."""
    up = math.cos(math.pi * v)
    rgb = [0.15, 0.14, 0.13] if up < 0 else [0.35 + 0.3 * up, 0.45 + 0.35 * up, 0.6 + 0.4 * up]

    def softbox(centre_u, centre_v, width, height, colour):
        du = min(abs(u - centre_u), 1.0 - abs(u - centre_u)) / width
        dv = abs(v - centre_v) / height
        if du < 1.0 and dv < 1.0:
            for i in range(3):
                rgb[i] += colour[i] * (1.0 - du * du) * (1.0 - dv * dv)

    softbox(0.60, 0.30, 0.09, 0.14, (9.0, 8.0, 6.5))
    softbox(0.28, 0.35, 0.05, 0.16, (1.5, 2.2, 3.2))
    return rgb


ASSETS = {
    "assets/checker.png": png(64, 64, checker),
    "assets/heights.png": png(64, 64, heights),
    "assets/leaf.png": png(64, 64, leaf),
    "assets/normals.png": png(64, 64, normals),
    "assets/sky.hdr": rgbe(64, 32, sky),
}
