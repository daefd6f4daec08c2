"""The Python module against closed forms, against the program, and as a guest in Python."""

import gc
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import palpate


def lattice(n, function, dtype=np.float64):
    """Values of function(x, y, z) at (i, j, k) of n^3 points on [-1, 1]^3, and their spacing."""
    axis = np.linspace(-1.0, 1.0, n)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    return np.stack(np.broadcast_arrays(*function(x, y, z)), axis=-1).astype(dtype, order="C"), [2.0 / (n - 1)] * 3


def rotation(x, y, z):
    return -y, x, 0.25 + 0.0 * z


class Fields(unittest.TestCase):
    def test_a_linear_field_is_sampled_as_it_is(self):
        for dtype in (np.float32, np.float64):
            values, spacing = lattice(9, rotation, dtype)
            field = palpate.uniform(values, spacing, [-1.0, -1.0, -1.0])
            x = np.random.default_rng(1).uniform(-1.0, 1.0, (1000, 3))
            found, status = field.sample(x)
            self.assertTrue((status == 0).all())
            np.testing.assert_allclose(found, np.stack(rotation(*x.T), axis=-1), atol=1e-6 if dtype == np.float32 else 1e-14)
            slopes, _ = field.jacobian(x)
            np.testing.assert_allclose(slopes[:, 0, 1], -1.0, atol=1e-5)
            np.testing.assert_allclose(slopes[:, 1, 0], 1.0, atol=1e-5)

    def test_axes_are_not_mixed(self):
        # Three counts, three spacings, a value that names its place.
        k, j, i = np.meshgrid(np.arange(3), np.arange(4), np.arange(5), indexing="ij")
        values = np.stack([i, j, k], axis=-1).astype(np.float64)
        field = palpate.uniform(values, [0.5, 2.0, 3.0], [10.0, 20.0, 30.0])
        found, status = field.sample([[10.5, 22.0, 33.0], [12.0, 26.0, 36.0], [12.1, 26.0, 36.0]])
        np.testing.assert_allclose(found[:2], [[1, 1, 1], [4, 3, 2]])
        self.assertEqual(list(status), [0, 0, 1])
        self.assertTrue(np.isnan(found[2]).all())

    def test_bad_values_are_told(self):
        values, spacing = lattice(5, rotation)
        values[2, 2, 2] = np.nan
        field = palpate.uniform(values, spacing, [-1.0] * 3)
        found, status = field.sample([[0.1, 0.1, 0.1], [0.9, 0.9, 0.9]])
        self.assertEqual(list(status), [2, 0])
        self.assertTrue(np.isnan(found[0]).all())

    def test_tetrahedra(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float)
        cells = [[0, 1, 2, 3], [4, 1, 2, 3]]
        matrix = np.array([[0.5, 1.0, 0.0], [0.0, -0.5, 2.0], [1.0, 0.0, 0.25]])
        field = palpate.tetrahedra(points, cells, points @ matrix.T)
        found, status = field.sample([[0.2, 0.3, 0.1], [0.5, 0.5, 0.5], [0.9, 0.9, 0.0]])
        self.assertEqual(list(status), [0, 0, 1])
        np.testing.assert_allclose(found[0], matrix @ [0.2, 0.3, 0.1], atol=1e-15)
        slopes, _ = field.jacobian([[0.2, 0.3, 0.1]])
        np.testing.assert_allclose(slopes[0], matrix, atol=1e-12)

    def test_refusals_name_what_was_expected(self):
        with self.assertRaisesRegex(palpate.InputError, "point 7"):
            palpate.tetrahedra(np.eye(3), [[0, 1, 2, 7]], np.eye(3))
        with self.assertRaisesRegex(ValueError, "nz, ny, nx, 3"):
            palpate.uniform(np.zeros((2, 2, 3)))
        with self.assertRaisesRegex(palpate.UsageError, "tornado"):
            palpate.example("no such field")
        with self.assertRaises(palpate.InputError):
            palpate.open("/no/such/file.vtu")

    def test_arrays_are_used_where_they_lie_and_let_go(self):
        values, spacing = lattice(17, rotation)
        before = sys.getrefcount(values)
        field = palpate.uniform(values, spacing, [-1.0] * 3)
        self.assertGreater(sys.getrefcount(values), before)
        lines = palpate.trace(field, [[0.3, 0.0, -0.9]])
        points = lines.points
        self.assertTrue(np.shares_memory(points, lines.points))
        self.assertFalse(points.flags.writeable)
        del field
        gc.collect()
        self.assertEqual(sys.getrefcount(values), before)
        del lines
        gc.collect()
        self.assertAlmostEqual(points[0, 0], 0.3)  # the array keeps its memory


class Lines(unittest.TestCase):
    def test_a_helix_stays_on_its_cylinder_within_the_stated_error(self):
        values, spacing = lattice(9, rotation)
        field = palpate.uniform(values, spacing, [-1.0] * 3)
        for method in ("dp54", "rk4"):
            lines = palpate.trace(field, [[0.5, 0.0, -1.0]], method=method, tolerance=1e-9)
            self.assertEqual(palpate.ends(lines), ["left_domain"])
            off = np.linalg.norm(
                lines.points - np.stack([0.5 * np.cos(lines.time), 0.5 * np.sin(lines.time), -1.0 + 0.25 * lines.time], -1),
                axis=1,
            )
            self.assertTrue((off <= 3.0 * lines.error + 1e-13).all(), method)
            self.assertGreater(len(off), 20)

    def test_lines_do_not_depend_on_threads(self):
        field = palpate.example("tornado")
        one = palpate.trace(field, "random:40", threads=1, direction="both")
        many = palpate.trace(field, "random:40", threads=4, direction="both")
        self.assertEqual(len(one), 80)
        self.assertTrue((one.points == many.points).all())
        self.assertTrue((one.offsets == many.offsets).all())

    def test_the_program_traces_the_same_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            seeds = os.path.join(folder, "seeds.csv")
            with open(seeds, "w") as out:
                out.write("x,y,z\n0.5,0.25,0.125\n4.5,2.375,0.75\n")
            theirs = os.path.join(folder, "flow.tck")
            subprocess.run(
                [os.environ["PALPATE_FLOW"], "trace", "--example", "abc", "--seeds", seeds, "--out", theirs, "--quiet"],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            ours = os.path.join(folder, "module.tck")
            field = palpate.example("abc")
            lines = palpate.trace(field, seeds)
            lines.save(ours)
            with open(theirs, "rb") as a, open(ours, "rb") as b:
                self.assertEqual(a.read(), b.read())
            with self.assertRaises(palpate.Error):
                lines.save(ours)  # it is there
            lines.save(ours, overwrite=True)

    def test_seeds_outside_are_counted(self):
        values, spacing = lattice(5, rotation)
        field = palpate.uniform(values, spacing, [-1.0] * 3)
        lines = palpate.trace(field, [[5.0, 0.0, 0.0], [0.1, 0.0, 0.0]])
        self.assertEqual(list(lines.outside_seeds), [0])
        self.assertEqual(list(lines.seed), [1])
        self.assertEqual([len(line) for line in palpate.each(lines)], [len(lines.points)])

    def test_control_c_ends_the_work(self):
        field = palpate.example("abc")
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        started = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            palpate.trace(field, "random:100000", max_length=1e6, tolerance=1e-12, max_steps=10**9)
        self.assertLess(time.monotonic() - started, 30.0)

    def test_other_threads_run_meanwhile(self):
        field = palpate.example("abc")
        ticks = []
        stop = threading.Event()

        def tick():
            while not stop.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        ticker = threading.Thread(target=tick)
        ticker.start()
        started = time.monotonic()
        palpate.trace(field, "random:20000", max_length=1000.0, threads=1)
        ended = time.monotonic()
        stop.set()
        ticker.join()
        meanwhile = [tick for tick in ticks if started < tick < ended]
        self.assertGreater(len(meanwhile), 5)
        self.assertLess(max(np.diff([started, *meanwhile, ended])), 0.7 * (ended - started))


class Files(unittest.TestCase):
    def test_a_file_opens_with_its_arrays(self):
        values, _ = lattice(6, lambda x, y, z: (1.0 + x, 2.0 * y, x * y * z))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "made.vtk")
            with open(path, "wb") as out:
                out.write(
                    b"# vtk DataFile Version 3.0\nmade\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 6 6\n"
                    b"ORIGIN -1 -1 -1\nSPACING 0.4 0.4 0.4\nPOINT_DATA 216\nSCALARS pressure double 1\n"
                    b"LOOKUP_TABLE default\n"
                )
                out.write(values[..., 1].astype(">f8").tobytes())
                out.write(b"\nVECTORS velocity double\n")
                out.write(values.astype(">f8").tobytes())
            data = palpate.open(path)
            self.assertEqual(data.format, "legacy VTK")
            self.assertEqual(sorted(a.name for a in data.arrays), ["pressure", "velocity"])
            field = data.vector()
            self.assertEqual(field.name, "velocity")
            found, _ = field.sample([[0.2, -0.2, 0.6]])
            np.testing.assert_allclose(found, [[1.2, -0.4, -0.024]], atol=1e-12)
            pressure = data.scalar("pressure")
            self.assertEqual(pressure.range, (-2.0, 2.0))
            slope, _ = pressure.gradient([[0.1, 0.1, 0.1]])
            np.testing.assert_allclose(slope, [[0.0, 2.0, 0.0]], atol=1e-12)
            with self.assertRaisesRegex(palpate.UsageError, "velocity"):
                data.vector("momentum")


if __name__ == "__main__":
    unittest.main()
