"""Touch in the Python module against closed forms and against the program."""

import csv
import os
import subprocess
import tempfile
import unittest

import numpy as np
import palpate

FAST = {"slew_cap": 1e6, "force_cap": 100.0}


def lattice(n, function):
    """Values of function(x, y, z) at (i, j, k) of n^3 points on [-1, 1]^3, and their place."""
    axis = np.linspace(-1.0, 1.0, n)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    return np.ascontiguousarray(function(x, y, z)), [2.0 / (n - 1)] * 3, [-1.0] * 3


def straight(start, end, n=200):
    return np.linspace(start, end, n)


class Constraints(unittest.TestCase):
    def test_a_plane_is_a_spring_on_one_side(self):
        chain = palpate.Chain([palpate.Plane([0, 0, 0.1], [0, 0, 2])], scale=0.5, settings={"stiffness": 300.0}, **FAST)
        path = straight([0.3, -0.2, 0.2], [0.3, -0.2, 0.08])
        touch = chain.run(path)
        self.assertEqual(touch.proxies.shape, (200, 1, 3))
        depth = np.maximum(0.1 - path[:, 2], 0.0)
        np.testing.assert_allclose(touch.proxies[:, 0], path + np.outer(depth, [0, 0, 1]), atol=1e-15)
        # The first step is free, and force grows from zero at a step of its own.
        np.testing.assert_allclose(touch.force[1:, 2], 300.0 * 0.5 * depth[1:], atol=1e-9)
        self.assertEqual([palpate.STATES[code] for code in touch.state_code[[0, -1]]], ["free", "held"])
        self.assertFalse(touch.force.flags.writeable)

    def test_an_isosurface_of_an_array_holds(self):
        values, spacing, origin = lattice(17, lambda x, y, z: x + 0.5 * y)
        field = palpate.scalar(values, spacing, origin)
        self.assertEqual(field.range, (-1.5, 1.5))
        chain = palpate.Chain([palpate.Isosurface(field, 0.5)], scale=0.02, **FAST)
        path = straight([0.0, 0.0, 0.1], [0.7, 0.0, 0.1])
        touch = chain.run(path)
        proxy = touch.proxies[-1, 0]
        self.assertAlmostEqual(proxy[0] + 0.5 * proxy[1], 0.5, delta=1e-9)
        normal = np.array([1.0, 0.5, 0.0]) / np.hypot(1.0, 0.5)
        beyond = (0.7 - 0.5) / np.hypot(1.0, 0.5)
        np.testing.assert_allclose(proxy, path[-1] - beyond * normal, atol=1e-7)
        np.testing.assert_allclose(touch.force[-1], -200.0 * 0.02 * beyond * normal, rtol=1e-5, atol=1e-8)

    def test_a_potential_of_an_array_pushes_down(self):
        values, spacing, origin = lattice(9, lambda x, y, z: 0.3 * x - 0.2 * z)
        chain = palpate.Chain([palpate.Potential(palpate.scalar(values.astype(np.float32), spacing, origin))], scale=0.1, **FAST)
        touch = chain.run(straight([-0.5, 0.1, 0.1], [0.5, 0.1, 0.1]))
        np.testing.assert_allclose(touch.force[1:], np.tile([-3.0, 0.0, 2.0], (199, 1)), atol=1e-5)

    def test_a_chain_of_a_streamline_and_a_plane(self):
        values, spacing, origin = lattice(9, lambda x, y, z: np.stack([1.0 + 0 * x, 0 * y, 0 * z], axis=-1))
        field = palpate.uniform(values, spacing, origin)
        links = [palpate.Streamline(field), palpate.Plane([0.4, 0, 0], [-1, 0, 0])]
        # The hand goes along the line, 0.05 beside it at last, and beyond the plane.
        path = straight([0.0, 0.2, 0.1], [0.5, 0.25, 0.1], 400)
        touch = palpate.Chain(links, scale=0.1, **FAST).run(path)
        np.testing.assert_allclose(touch.proxies[-1, 0], [0.5, 0.2, 0.1], atol=1e-9)
        np.testing.assert_allclose(touch.proxies[-1, 1], [0.4, 0.2, 0.1], atol=1e-9)
        np.testing.assert_allclose(touch.force[-1], [-200 * 0.1 * 0.1, -200 * 0.1 * 0.05, 0.0], rtol=1e-6, atol=1e-7)

    def test_refusals(self):
        with self.assertRaisesRegex(palpate.UsageError, "isosurface.depth"):
            palpate.Chain([palpate.Drag()], settings={"stifness": 1.0})
        with self.assertRaisesRegex(palpate.UsageError, r"one to \d+ links"):
            palpate.Chain([])
        with self.assertRaisesRegex(palpate.UsageError, "not zero"):
            palpate.Plane([0, 0, 0], [0, 0, 0])
        with self.assertRaisesRegex(ValueError, "n, 3"):
            palpate.Chain([palpate.Drag()]).run([0.0, 1.0, 2.0])
        with self.assertRaisesRegex(ValueError, "times"):
            palpate.Chain([palpate.Drag()]).run(np.zeros((3, 3)), [0.0, 1.0])
        with self.assertRaisesRegex(ValueError, "nz, ny, nx"):
            palpate.scalar(np.zeros((2, 2)))


class Program(unittest.TestCase):
    def test_probe_feels_the_same(self):
        path = straight([1.0, 1.0, 1.0], [1.6, 1.2, 0.9], 500)
        times = 0.002 * np.arange(500)
        with tempfile.TemporaryDirectory() as folder:
            name, log = os.path.join(folder, "path.csv"), os.path.join(folder, "log.csv")
            with open(name, "w") as out:
                out.write("t,x,y,z\n")
                for t, (x, y, z) in zip(times, path):
                    out.write(f"{t!r},{x!r},{y!r},{z!r}\n".replace("np.float64(", "").replace(")", ""))
            subprocess.run(
                [os.environ["PALPATE_FLOW"], "probe", "--example", "abc", "--path", name, "--out", log, "--quiet"],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            with open(log) as table:
                rows = list(csv.DictReader(table))
        touch = palpate.Chain([palpate.Streamline(palpate.example("abc"))]).run(path, times)
        self.assertEqual(len(rows), len(touch))
        for columns, ours in ((("px", "py", "pz"), touch.proxies[:, 0]), (("fx", "fy", "fz"), touch.force)):
            theirs = np.array([[float(row[c]) for c in columns] for row in rows])
            self.assertTrue((theirs == ours).all(), columns)
        self.assertEqual([row["state"] for row in rows], palpate.states(touch))
        self.assertGreater(np.linalg.norm(touch.force, axis=1).max(), 0.5)


if __name__ == "__main__":
    unittest.main()
