#!/usr/bin/env python3
"""screen_picture.py FILE PICTURE.png: what Xvfb -fbdir shows (a file of the X window dump format), as a PNG."""
import struct
import sys
import zlib


def main() -> None:
    dump = open(sys.argv[1], "rb").read()
    header = struct.unpack(">25I", dump[:100])
    header_size, width, height = header[0], header[4], header[5]
    bits_per_pixel, bytes_per_line, colors = header[11], header[12], header[19]
    if bits_per_pixel != 32:
        sys.exit("screen_picture: a screen of 24 bits is wanted")
    first = header_size + 12 * colors
    rows = []
    for y in range(height):
        row = dump[first + y * bytes_per_line : first + y * bytes_per_line + 4 * width]
        pixels = bytearray(3 * width)
        pixels[0::3], pixels[1::3], pixels[2::3] = row[2::4], row[1::4], row[0::4]  # from blue, green, red
        rows.append(b"\0" + bytes(pixels))

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(sys.argv[2], "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


main()
