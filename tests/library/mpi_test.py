"""palpate-mpi against flow: the same file, byte for byte, for any number of ranks, and after a rank was lost."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import numpy as np

FLOW, MPI, MPIRUN = (os.environ[name] for name in ("PALPATE_FLOW", "PALPATE_MPI", "PALPATE_MPIRUN"))
SHARED = next((p for p in (pathlib.Path(os.environ["PALPATE_SOURCE"]) / "shared",
                           pathlib.Path(os.environ["PALPATE_SOURCE"]).parent / "shared") if p.exists()), None)
# More ranks than processors, on one machine, whoever runs the tests.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}


def mpi_command(ranks, *arguments):
    return [MPIRUN, "-n", str(ranks), MPI, "trace", *map(str, arguments)]


def run_mpi(ranks, *arguments):
    return subprocess.run(mpi_command(ranks, *arguments), capture_output=True, text=True, env=ENVIRONMENT, timeout=600)


def abc_flow(n):
    """The ABC flow on n^3 points, float32, shape (n, n, n, 3)."""
    axis = np.linspace(0.0, 2.0 * np.pi, n)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    a, b, c = np.sqrt(3.0), np.sqrt(2.0), 1.0
    return np.stack([a * np.sin(z) + c * np.cos(y), b * np.sin(x) + a * np.cos(z), c * np.sin(y) + b * np.cos(x)],
                    axis=-1).astype(np.float32)


def write_nrrd(path, values):
    """A NRRD of raw vectors whose numbers begin at a multiple of 4 bytes."""
    nz, ny, nx, _ = values.shape
    h = 2.0 * np.pi / (nx - 1)
    header = (f"NRRD0004\ntype: float\ndimension: 4\nsizes: 3 {nx} {ny} {nz}\nencoding: raw\nendian: little\n"
              "kinds: vector domain domain domain\nspace dimension: 3\n"
              f"space directions: none ({h!r},0,0) (0,{h!r},0) (0,0,{h!r})\nspace origin: (0,0,0)\n")
    header += "#" * (2 + -len(header) % 4) + "\n\n"
    assert len(header) % 4 == 0
    path.write_bytes(header.encode() + values.astype("<f4").tobytes())


def write_foam(case, processors, n):
    """A box of n^3 cells in as many layers along z as there are processors, each with its part, and U of cells."""
    def header(kind, name):
        return f"FoamFile\n{{ version 2.0; format ascii; class {kind}; object {name}; }}\n"

    def listed(rows):
        return f"{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n"

    def vector(x):
        return "(" + " ".join(repr(float(c)) for c in x) + ")"

    (case / "system").mkdir(parents=True)
    (case / "system/controlDict").write_text(header("dictionary", "controlDict") + "startTime 0;\n")
    high = n // processors
    for p in range(processors):
        folder = case / f"processor{p}"
        (folder / "constant/polyMesh").mkdir(parents=True)
        (folder / "0").mkdir()
        point = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)
        cell = lambda i, j, k: i + n * (j + n * k)
        inner, sides, below, above = [], [], [], []
        for k in range(high):
            for j in range(n):
                for i in range(n):
                    for axis, (a, b) in enumerate((((0, 1, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, 1, 0)))):
                        for up in (0, 1):
                            at, beside = [i, j, k], [i, j, k]
                            at[axis] += up
                            beside[axis] += 2 * up - 1
                            corners = [point(*np.add(at, d)) for d in ((0, 0, 0), a, np.add(a, b), b)]
                            size = (n, n, high)[axis]
                            if 0 <= beside[axis] < size:
                                if up:
                                    inner.append((corners, cell(i, j, k), cell(*beside)))
                                continue
                            place = sides if axis < 2 else (above, below)[1 - up]
                            place.append((corners if up else corners[::-1], cell(i, j, k), None))
        inner.sort(key=lambda face: face[1:])
        patches = [("walls", "patch", sides + (below if p == 0 else []) + (above if p == processors - 1 else []))]
        for other, faces in ((p - 1, below), (p + 1, above)):
            if 0 <= other < processors:
                patches.append((f"procBoundary{p}to{other}", f"processor; myProcNo {p}; neighbProcNo {other}", faces))
        faces = inner + [face for _, _, part in patches for face in part]
        mesh = folder / "constant/polyMesh"
        places = [vector((i / n, j / n, (k + high * p) / n)) for k in range(high + 1) for j in range(n + 1) for i in range(n + 1)]
        (mesh / "points").write_text(header("vectorField", "points") + listed(places))
        (mesh / "faces").write_text(header("faceList", "faces") + listed([f"4({' '.join(map(str, f[0]))})" for f in faces]))
        (mesh / "owner").write_text(header("labelList", "owner") + listed([str(f[1]) for f in faces]))
        (mesh / "neighbour").write_text(header("labelList", "neighbour") + listed([str(f[2]) for f in inner]))
        text, start = [], len(inner)
        for name, kind, part in patches:
            text.append(f"{name} {{ type {kind}; nFaces {len(part)}; startFace {start}; }}")
            start += len(part)
        (mesh / "boundary").write_text(header("polyBoundaryMesh", "boundary") + listed(text))
        middle = [((i + 0.5) / n, (j + 0.5) / n, (k + high * p + 0.5) / n) for k in range(high) for j in range(n) for i in range(n)]
        flow = [vector((0.5 - y, x - 0.5, 0.3 + 0.2 * np.sin(6 * x))) for x, y, _ in middle]
        fields = " ".join(f"{name} {{ type {'zeroGradient' if name == 'walls' else 'processor'}; "
                          + ("" if name == "walls" else "value uniform (0 0 0); ") + "}" for name, _, _ in patches)
        (folder / "0/U").write_text(header("volVectorField", "U") + "dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform List<vector>\n"
                                    + listed(flow) + f";\nboundaryField {{ {fields} }}\n")


class Case(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)

    def reference(self, *arguments):
        out = self.folder / "flow.vtp"
        subprocess.run([FLOW, "trace", *map(str, arguments), "--quiet", "--force", "--out", str(out)], check=True,
                       capture_output=True, timeout=600)
        return out.read_bytes()

    def check_same(self, *arguments, ranks=(1, 2, 3, 8), blocks=16, pieces=2000, volume_in_memory=True):
        expected = self.reference(*arguments)
        for n in ranks:
            out = self.folder / f"mpi{n}.vtp"
            done = run_mpi(n, *arguments, "--out", out, "--blocks", blocks, "--round-pieces", pieces, "--json", "--force")
            self.assertEqual(done.returncode, 0, done.stderr)
            figures = json.loads(done.stdout)
            self.assertEqual(figures["ranks"], n)
            self.assertGreater(figures["rounds"], 1)
            if n > 1:
                self.assertGreater(figures["lines_moved"], 0)
                self.assertGreater(figures["bytes_sent"], 0)
            self.assertTrue(out.read_bytes() == expected, f"other bits with {n} ranks")
            self.assertFalse((self.folder / f"mpi{n}.vtp.work").exists())
            self.assertEqual("each rank holds the whole field" in done.stderr, volume_in_memory, done.stderr)


class SameBits(Case):
    def test_a_uniform_grid_that_stays_on_the_disk(self):
        volume = self.folder / "abc.nrrd"
        write_nrrd(volume, abc_flow(33))
        self.check_same(volume, "--seeds", "random:60", "--direction", "both", blocks=64, volume_in_memory=False)
        self.check_same(volume, "--seeds", "grid:3,3,3", "--integrator", "rk4", ranks=(3,), volume_in_memory=False)
        self.check_same(volume, "--seeds", "grid:3,3,3", "--integrator", "bs32", "--step", "0.3", ranks=(3,),
                        volume_in_memory=False)

    def test_methods_on_tetrahedra(self):
        if SHARED is None:
            self.skipTest("no shared/ beside the checkout")
        fin = [SHARED / "data/flow/bluntfin/bluntfinxyz.bin", "--solution", SHARED / "data/flow/bluntfin/bluntfinq.bin"]
        self.check_same(*fin, "--seeds", "random:40", "--direction", "both", "--seed", "7")
        self.check_same(*fin, "--seeds", "random:20", "--integrator", "dp54", ranks=(3,), pieces=500)

    def test_cells_that_share_no_points(self):
        if SHARED is None:
            self.skipTest("no shared/ beside the checkout")
        self.check_same(SHARED / "cases/flow/dg_hex.vtu", "--seeds", "random:40", "--direction", "both", pieces=50)
        self.check_same(SHARED / "cases/flow/dg_hex.vtu", "--seeds", "random:20", "--integrator", "dp54", ranks=(3,), pieces=50)

    def test_processors_of_openfoam(self):
        case = self.folder / "case"
        write_foam(case, 3, 9)
        self.check_same(case, "--seeds", "random:40", "--direction", "both", pieces=300)


class Trouble(Case):
    def test_seeds_outside_are_counted_and_a_folder_of_another_run_is_kept(self):
        volume = self.folder / "abc.nrrd"
        write_nrrd(volume, abc_flow(9))
        out = self.folder / "lines.vtp"
        none = run_mpi(2, volume, "--seeds", "point:-5,0,0", "--out", out)
        self.assertEqual(none.returncode, 1)
        self.assertIn("no line: all 1 seed lie outside the data", none.stderr)
        other = run_mpi(2, volume, "--seeds", "random:4", "--out", out)
        self.assertEqual(other.returncode, 2)
        self.assertIn("holds another run (1 seed", other.stderr)
        self.assertEqual(other.stderr.count("palpate-mpi:"), 1, other.stderr)

    def test_a_lost_rank_is_said_and_the_run_goes_on_where_it_was(self):
        volume = self.folder / "abc.nrrd"
        write_nrrd(volume, abc_flow(33))
        # About a hundred rounds, the first few of which are over long before the last.
        job = [volume, "--seeds", "random:3000", "--direction", "both", "--tolerance", "1e-9", "--max-length", "200"]
        expected = self.reference(*job)
        out, work = self.folder / "lines.vtp", self.folder / "work"
        job += ["--out", out, "--work", work, "--keep-every", "0", "--round-pieces", "3000", "--json"]
        running = subprocess.Popen(mpi_command(3, *job), stderr=subprocess.PIPE, text=True, env=ENVIRONMENT,
                                   start_new_session=True)
        while running.poll() is None and not self.rounds(work) >= 3:
            time.sleep(0.02)
        self.assertIsNone(running.poll(), "it was done before it could be disturbed")
        os.kill(self.a_rank(work), signal.SIGKILL)
        _, said = running.communicate(timeout=300)
        self.assertNotEqual(running.returncode, 0)
        self.assertIn("give the same command again", said)
        self.assertFalse(out.exists())
        again = run_mpi(2, *job)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertGreaterEqual(json.loads(again.stdout)["resumed_from"], 3)
        self.assertTrue(out.read_bytes() == expected, "other bits after a rank was lost")

    @staticmethod
    def rounds(work):
        try:
            return len((work / "whole").read_text().splitlines())
        except FileNotFoundError:
            return 0

    @staticmethod
    def a_rank(work):
        """The process id of the last rank that works in this folder."""
        found = []
        for process in pathlib.Path("/proc").iterdir():
            try:
                words = (process / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if words[0] == MPI.encode() and str(work).encode() in words:
                found.append(int(process.name))
        return max(found)


if __name__ == "__main__":
    unittest.main()
