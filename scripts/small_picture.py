#!/usr/bin/env python3
"""Makes a PNG of a trial small, for docs: scripts/small_picture.py IN.png OUT.png [PARTS]

Each pixel becomes the nearest of 248 colours: greys, and blends of greys with the red and the blue of the marks
(common/study/study_appearance.h), so that marks of a few pixels keep theirs. PARTS (1, 2, ...) pixels a side become one
first, by their mean. Reads 8-bit RGB and RGBA that is not interlaced, which is what the programs write.
"""
import struct
import sys
import zlib

RED, BLUE = (219, 20, 20), (20, 56, 242)


def read_png(path):
    data = open(path, "rb").read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            if depth != 8 or color not in (2, 6) or interlaced:
                sys.exit(f"{path}: 8-bit RGB or RGBA, not interlaced, is expected")
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    n = 3 if color == 2 else 4
    raw, stride, rows, before = zlib.decompress(packed), width * n, [], bytearray(width * n)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride if kind else 0):
            a = row[i - n] if i >= n else 0
            b, c = before[i], before[i - n] if i >= n else 0
            if kind == 4:
                p = a + b - c
                near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, near if kind == 4 else 0)[kind]) & 255
        rows.append([tuple(row[i : i + 3]) for i in range(0, stride, n)])
        before = row
    return rows


def means(rows, parts):
    out = []
    for y in range(0, len(rows) - parts + 1, parts):
        line = []
        for x in range(0, len(rows[0]) - parts + 1, parts):
            block = [rows[y + j][x + i] for j in range(parts) for i in range(parts)]
            line.append(tuple(round(sum(p[k] for p in block) / len(block)) for k in range(3)))
        out.append(line)
    return out


def palette():
    colors = [(g, g, g) for g in (round(255 * i / 119) for i in range(120))]
    for mark in (RED, BLUE):
        for share in (i / 8 for i in range(1, 9)):
            for grey in (round(255 * i / 7) for i in range(8)):
                colors.append(tuple(round((1 - share) * grey + share * m) for m in mark))
    return colors


def write_png(path, rows, colors):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    known = {}

    def index(pixel):
        if pixel not in known:
            known[pixel] = min(range(len(colors)), key=lambda i: sum((a - b) ** 2 for a, b in zip(pixel, colors[i])))
        return known[pixel]

    raw = b"".join(b"\0" + bytes(index(p) for p in row) for row in rows)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")
        out.write(chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)))
        out.write(chunk(b"PLTE", bytes(v for color in colors for v in color)))
        out.write(chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    rows = read_png(sys.argv[1])
    parts = int(sys.argv[3]) if len(sys.argv) == 4 else 1
    write_png(sys.argv[2], means(rows, parts) if parts > 1 else rows, palette())


main()
