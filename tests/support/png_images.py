"""Reads PNG files with nothing but Python."""
import struct
import zlib


def read_png(path):
    """Width, height and rows of (r, g, b) of a PNG with 8 bits for each of three colours."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        (length,), kind = struct.unpack_from(">I", data, at), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colours, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (depth, colours, interlaced) == (8, 2, 0), path
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    return width, height, unfiltered(zlib.decompress(packed), width, height)


def unfiltered(raw, width, height):
    size, rows, above = 3 * width, [], bytes(3 * width)
    for number in range(height):
        kind, line = raw[number * (size + 1)], bytearray(raw[number * (size + 1) + 1:(number + 1) * (size + 1)])
        for i in range(size):
            left, up, corner = (line[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
            nearest = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, size, 3)])
        above = bytes(line)
    return rows
