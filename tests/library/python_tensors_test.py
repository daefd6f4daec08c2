"""Tensors, tracts and layers in the Python module against closed forms and against the program."""

import importlib.util
import os
import subprocess
import tempfile
import unittest

import numpy as np
import palpate


def directions(n=12, seed=3):
    v = np.random.default_rng(seed).normal(size=(n, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


def weighted_image(shape, tensor_of):
    """Signals of tensors tensor_of(k, j, i) without noise, with their gradients: an unweighted volume and 12 others."""
    g = directions()
    bvals = np.array([0.0] + [1000.0] * len(g))
    bvecs = np.vstack([[0.0, 0.0, 0.0], g])
    signals = np.empty((*shape, len(bvals)), dtype=np.float32)
    for at in np.ndindex(*shape):
        d = tensor_of(*at)
        signals[at] = 500.0 * np.exp(-bvals * np.einsum("va,ab,vb->v", bvecs, d, bvecs))
    return signals, bvals, bvecs


def axial(direction, along=1.7e-3, across=0.3e-3):
    e = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    return across * np.eye(3) + (along - across) * np.outer(e, e)


class Fit(unittest.TestCase):
    def test_tensors_without_noise_come_back(self):
        shape = (2, 3, 4)
        tensor = lambda k, j, i: axial([1.0 + i, 0.5 * j, 0.25 * k])
        signals, bvals, bvecs = weighted_image(shape, tensor)
        for weighted in (True, False):
            found = palpate.fit_tensors(signals, bvals, bvecs, masked=False, weighted=weighted)
            self.assertEqual(found.values.shape, (*shape, 6))
            for at in np.ndindex(*shape):
                d = tensor(*at)
                np.testing.assert_allclose(
                    found.values[at], [d[0, 0], d[0, 1], d[0, 2], d[1, 1], d[1, 2], d[2, 2]], atol=3e-9
                )
        fa = found.measure("fa")
        l1, l2 = 1.7e-3, 0.3e-3
        mean = (l1 + 2 * l2) / 3
        truth = np.sqrt(1.5 * ((l1 - mean) ** 2 + 2 * (l2 - mean) ** 2) / (l1**2 + 2 * l2**2))
        np.testing.assert_allclose(fa, np.full(shape, truth), atol=1e-5)
        self.assertEqual(found.measure("v1").shape, (*shape, 3))
        self.assertTrue(any("weighted" in note for note in found.notes))
        with self.assertRaisesRegex(palpate.UsageError, "mode"):
            found.measure("colour of the sky")

    def test_the_affine_places_the_voxels(self):
        affine = np.array([[0, -2.0, 0, 10], [1.5, 0, 0, -4], [0, 0, 3.0, 7], [0, 0, 0, 1]])
        signals, bvals, bvecs = weighted_image((5, 5, 9), lambda k, j, i: axial([0, 1, 0]))
        found = palpate.fit_tensors(signals, bvals, bvecs, affine=affine, masked=False)
        np.testing.assert_array_equal(found.affine, affine)
        seed = affine @ [4, 2, 2, 1]
        tracts = palpate.tracts(found, [seed[:3]])
        self.assertEqual(len(tracts), 1)
        # Along the first index, from one border of the image to the other.
        np.testing.assert_allclose(tracts.points[:, [0, 2]], np.tile(seed[[0, 2]], (len(tracts.points), 1)), atol=1e-4)
        low, high = sorted([tracts.points[0, 1], tracts.points[-1, 1]])
        self.assertLess(low, -3.9)
        self.assertGreater(high, 7.9)
        self.assertEqual({palpate.ENDS[code] for code in tracts.end_codes[0]}, {"left_domain"})

    def test_refusals(self):
        signals, bvals, bvecs = weighted_image((2, 2, 2), lambda k, j, i: axial([1, 0, 0]))
        with self.assertRaisesRegex(palpate.InputError, "13 for each voxel|12 weightings and 13 directions"):
            palpate.fit_tensors(signals, bvals[1:], bvecs)
        with self.assertRaisesRegex(palpate.InputError, "direction"):
            palpate.fit_tensors(signals, bvals, np.tile([1.0, 0.0, 0.0], (13, 1)), masked=False)
        with self.assertRaisesRegex(ValueError, "nz, ny, nx, volumes"):
            palpate.fit_tensors(signals[0], bvals, bvecs)
        with self.assertRaisesRegex(palpate.UsageError, "helix"):
            palpate.example_tensors("no such image")


class Tracts(unittest.TestCase):
    def test_the_program_traces_the_same_tracts(self):
        image = palpate.example_tensors("helix")
        fa = image.measure("fa")
        k, j, i = np.unravel_index(np.nanargmax(fa), fa.shape)
        seed = (image.affine @ [i, j, k, 1])[:3]
        with tempfile.TemporaryDirectory() as folder:
            theirs, ours = os.path.join(folder, "dtmri.tck"), os.path.join(folder, "module.tck")
            place = ",".join(repr(float(x)) for x in seed)
            subprocess.run(
                [os.environ["PALPATE_DTMRI"], "trace", "--example", "helix", "--seeds", f"point:{place}", "--out", theirs,
                 "--quiet"],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            tracts = palpate.tracts(image, [seed])
            tracts.save(ours)
            with open(theirs, "rb") as a, open(ours, "rb") as b:
                self.assertEqual(a.read(), b.read())
            with self.assertRaises(palpate.Error):
                tracts.save(ours)
        self.assertGreater(len(tracts.points), 20)
        self.assertTrue((tracts.error >= 0).all())

    def test_seeds_without_a_tract_are_told(self):
        image = palpate.example_tensors("helix")
        tracts = palpate.tracts(image, [[1e6, 0.0, 0.0]])
        self.assertEqual(len(tracts), 0)
        self.assertEqual(tracts.notes, ["1 seed outside the image"])

    @unittest.skipUnless(importlib.util.find_spec("nibabel"), "nibabel is not installed")
    def test_nibabel_gets_them(self):
        image = palpate.example_tensors("helix")
        tracts = palpate.tracts(image, [(image.affine @ [8, 8, 8, 1])[:3]])
        made = palpate.to_nibabel(tracts)
        self.assertEqual(len(made.streamlines), len(tracts))

    @unittest.skipUnless(importlib.util.find_spec("dipy"), "DIPY is not installed")
    def test_dipy_gets_them(self):
        image = palpate.example_tensors("helix")
        tracts = palpate.tracts(image, [(image.affine @ [8, 8, 8, 1])[:3]])
        self.assertEqual(len(palpate.to_dipy(tracts, image).streamlines), len(tracts))


def shell(inner, outer, layers, n):
    """A thick shell: the surface of a cube of n^2 squares a side blown up to a sphere, in `layers` layers."""
    axis = np.linspace(-1.0, 1.0, n + 1)
    points, index, cells = [], {}, []

    def point(cube, r):
        key = (tuple(np.round(cube, 9)), round(r, 9))
        if key not in index:
            index[key] = len(points)
            points.append(r * np.asarray(cube) / np.linalg.norm(cube))
        return index[key]

    radii = np.linspace(inner, outer, layers + 1)
    for side in range(6):
        a, sign = side % 3, 1.0 if side < 3 else -1.0
        for u in range(n):
            for v in range(n):
                square = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    cube = np.empty(3)
                    cube[a], cube[(a + 1) % 3], cube[(a + 2) % 3] = sign, axis[u + du], axis[v + dv]
                    square.append(cube)
                for low, high in zip(radii[:-1], radii[1:]):
                    for corners in ((0, 1, 2), (0, 2, 3)):
                        # The diagonals of a prism's sides go from its lowest point upwards, alike in both neighbours.
                        key = lambda c: tuple(np.round(square[c], 9))
                        x, y, z = sorted(corners, key=key)
                        bottom = [point(square[c], low) for c in (x, y, z)]
                        top = [point(square[c], high) for c in (x, y, z)]
                        cells += [[bottom[0], bottom[1], bottom[2], top[2]], [bottom[0], bottom[1], top[1], top[2]],
                                  [bottom[0], top[0], top[1], top[2]]]
    return np.array(points), np.array(cells)


class Layers(unittest.TestCase):
    def test_a_shell_has_the_depth_of_a_potential(self):
        inner, outer = 20.0, 30.0
        points, cells = shell(inner, outer, 6, 8)
        depth, notes = palpate.layers(points, cells)
        r = np.linalg.norm(points, axis=1)
        truth = (1 / inner - 1 / r) / (1 / inner - 1 / outer)
        self.assertLess(np.abs(depth - truth).max(), 0.02)
        self.assertTrue(((depth >= 0) & (depth <= 1)).all())
        self.assertTrue(notes)

    def test_refusals(self):
        with self.assertRaisesRegex(palpate.InputError, "point 9"):
            palpate.layers(np.eye(3), [[0, 1, 2, 9]])


if __name__ == "__main__":
    unittest.main()
