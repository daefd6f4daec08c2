"""Pictures in Python: the pixels of the program's own picture of the same lines."""

import os
import subprocess
import tempfile
import unittest
import zlib

import numpy as np
import palpate


def read_png(path):
    """The pixels of a PNG of 8 bits a channel, not interlaced (ISO/IEC 15948), shape (height, width, channels)."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
            channels = {2: 3, 6: 4}[body[9]]
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + channels * width).astype(int)
    pixels = np.zeros((height + 1, width + 1, channels), int)  # a border of zeros above and to the left
    for y, (kind, *row) in enumerate(rows.tolist()):
        for x, filtered in enumerate(np.reshape(row, (width, channels))):
            left, up, corner = pixels[y + 1, x], pixels[y, x + 1], pixels[y, x]
            if kind == 4:
                p = left + up - corner
                a, b, c = abs(p - left), abs(p - up), abs(p - corner)
                base = np.where((a <= b) & (a <= c), left, np.where(b <= c, up, corner))
            else:
                base = (0, left, up, (left + up) // 2)[kind]
            pixels[y + 1, x + 1] = (filtered + base) % 256
    return pixels[1:, 1:].astype(np.uint8)


class Render(unittest.TestCase):
    def test_pixels_are_those_of_the_program(self):
        field = palpate.example("abc")
        lines = palpate.trace(field, "grid:3,3,3", direction="both", max_length=field.diagonal)
        pixels = palpate.render(field, lines, size=(320, 200), camera="30,20,0,1", color="error", title="example abc")
        self.assertEqual((pixels.shape, pixels.dtype), ((200, 320, 4), np.uint8))
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "abc.png")
            subprocess.run([os.environ["PALPATE_FLOW"], "render", "--example", "abc", "--seeds", "grid:3,3,3", "--size",
                            "320x200", "--camera", "30,20,0,1", "--color", "error", "--out", out],
                           check=True, capture_output=True)
            expected = read_png(out)[..., :3]
        self.assertGreater(len(np.unique(expected.reshape(-1, 3), axis=0)), 100)
        np.testing.assert_array_equal(pixels[..., :3], expected)

    def test_an_array_keeps_its_picture_and_is_not_written_to(self):
        field = palpate.example("abc")
        pixels = palpate.render(field, palpate.trace(field, "random:2"), size=(64, 48))
        with self.assertRaises(ValueError):
            pixels[0, 0, 0] = 1
        self.assertTrue((pixels[..., 3] == 255).all())

    def test_words_that_are_not_known_are_refused(self):
        field = palpate.example("abc")
        lines = palpate.trace(field, "random:2")
        for wrong in ({"color": "smell"}, {"camera": "1,2"}, {"background": "plaid"}, {"size": (0, 10)}):
            with self.assertRaises(palpate.UsageError, msg=wrong):
                palpate.render(field, lines, **wrong)


if __name__ == "__main__":
    unittest.main()
