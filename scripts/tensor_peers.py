#!/usr/bin/python3
"""tensor_peers.py DTMRI [DWI.nii.gz ...]: FA, MD, V1 and tract files of dtmri beside MRtrix, DIPY and nibabel, as a table.
tensor_peers.py --tracts IMAGE.nii.gz STEM ...: STEM.trx, .trk and .tck, the same lines, as those open them over the image.

DTMRI is the built program. Each series has its .bval and .bvec beside it; without one, oblique series are made by
formula, in three storage orders. A program that is not installed is named below the table. The exit status is 1 where a
row differs by more than it may, 77 where nibabel is not installed.
"""
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

try:
    import nibabel as nib
except ImportError:
    print("tensor_peers: nibabel is needed (python3-nibabel), by Debian's /usr/bin/python3", file=sys.stderr)
    sys.exit(77)
try:
    from dipy.core.gradients import gradient_table
    from dipy.io.streamline import load_tractogram
    from dipy.reconst.dti import TensorModel
except ImportError:
    TensorModel = None

ROWS, ABSENT = [], set()
MOST_MM = 2e-3  # .trk and float16 of peers: single precision at the far end of a head
MOST_DEGREES = 0.05


def run(*words):
    done = subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError(" ".join(map(str, words)) + ": " + done.stderr.strip()[-300:])
    return done.stderr


def add(series, what, peer, difference, most, unit, note=""):
    ok = bool(difference <= most)
    ROWS.append((series, what, peer, f"{difference:.2g} {unit}".strip(), f"{most:g}", "yes" if ok else "NO", note))


def made_series(folder, order):
    """Tensors that turn from voxel to voxel about a known axis; an oblique affine, stored in `order`."""
    affine = np.array([[1.86, -.80, -.14, -14.], [.68, 2.0, -.60, -25.], [.28, .45, 2.42, -4.], [0, 0, 0, 1.]])
    shape = (16, 14, 12)
    i, j, k = np.meshgrid(*map(np.arange, shape), indexing="ij")
    a, b = .05 * i + .11 * j, .07 * k - .04 * i
    v = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], -1)
    tensors = 1.7e-3 * np.einsum("...p,...q->...pq", v, v) + 3e-4 * (np.eye(3) - np.einsum("...p,...q->...pq", v, v))
    rng = np.random.default_rng(3)
    g = rng.normal(size=(30, 3))
    g /= np.linalg.norm(g, axis=1)[:, None]
    bvals = np.r_[0, 0, np.full(30, 1000.)]
    directions = np.r_[np.zeros((2, 3)), g]
    signal = 1000 * np.exp(-bvals * np.einsum("np,...pq,nq->...n", directions, tensors, directions))
    image = nib.Nifti1Image(signal.astype("f4"), affine)
    image = image.as_reoriented(nib.orientations.ornt_transform(
        nib.orientations.io_orientation(affine), nib.orientations.axcodes2ornt(tuple(order))))
    path = os.path.join(folder, order + ".nii.gz")
    image.header.set_xyzt_units("mm")
    nib.save(image, path)
    # FSL: along the image's axes, x turned around where the determinant is positive.
    axes = image.affine[:3, :3]
    unit, _, vt = np.linalg.svd(axes)
    own = directions @ (unit @ vt)
    if np.linalg.det(axes) > 0:
        own[:, 0] *= -1
    np.savetxt(path[:-7] + ".bvec", own.T)
    np.savetxt(path[:-7] + ".bval", bvals[None])
    return path


def angle(a, b, mask):
    a, b = (x / np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-30) for x in (a[mask], b[mask]))
    return np.degrees(np.arccos(np.clip(np.abs((a * b).sum(-1)), 0, 1))).max()


def compare_images(dtmri, path, folder):
    name = os.path.basename(path)
    table = path[: -len(".nii.gz")]
    ours = {}
    for measure in ("fa", "md", "v1"):
        out = os.path.join(folder, "own_" + measure + ".nii.gz")
        run(dtmri, "measure", path, "--measure", measure, "--out", out, "--force", "--quiet")
        ours[measure] = np.squeeze(nib.load(out).get_fdata())
    own_vectors = nib.load(os.path.join(folder, "own_v1.nii.gz"))
    sure = (ours["fa"] > .2) & (ours["fa"] < .99)
    mask = ours["md"] > 0
    if shutil.which("dwi2tensor"):
        dt = os.path.join(folder, "dt.mif")
        run("dwi2tensor", path, dt, "-fslgrad", table + ".bvec", table + ".bval", "-force", "-quiet")
        theirs = {}
        for measure, option in (("fa", "-fa"), ("md", "-adc"), ("v1", "-vector")):
            out = os.path.join(folder, "mrtrix_" + measure + ".nii.gz")
            extra = ["-modulate", "none"] if measure == "v1" else []
            run("tensor2metric", dt, option, out, *extra, "-force", "-quiet")
            theirs[measure] = np.squeeze(nib.load(out).get_fdata())
        # Two things are not alike by design: what a signal of zero and less is taken for, and that measures of ours take
        # an eigenvalue below zero as zero.
        run("mrconvert", dt, os.path.join(folder, "dt.nii.gz"), "-force", "-quiet")
        six = np.nan_to_num(nib.load(os.path.join(folder, "dt.nii.gz")).get_fdata())  # xx yy zz xy xz yz
        positive = np.linalg.eigvalsh(six[..., [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(six.shape[:3] + (3, 3)))[..., 0] > 0
        signal = nib.load(path).get_fdata().min(-1) > 0
        both = mask & sure & positive & signal
        left_out = int((mask & sure & ~both).sum())
        note = f"{int(both.sum())} voxels" + (f", {left_out} with a signal or an eigenvalue of zero or less apart" if left_out else "")
        add(name, "FA", "MRtrix", np.abs(ours["fa"] - theirs["fa"])[both].max(), 2e-4, "", note)
        add(name, "MD", "MRtrix", (np.abs(ours["md"] - theirs["md"]) / theirs["md"])[both].max(), 2e-4, "relative")
        add(name, "V1", "MRtrix", angle(ours["v1"], theirs["v1"], both), MOST_DEGREES, "degrees", "scanner axes")
    else:
        ABSENT.add("MRtrix (mrtrix3)")
    if TensorModel is not None:
        image = nib.load(path)
        bvals, bvecs = np.loadtxt(table + ".bval"), np.loadtxt(table + ".bvec").T
        gradients = gradient_table(bvals.ravel(), bvecs, b0_threshold=10)
        fit = TensorModel(gradients, fit_method="WLS").fit(np.maximum(image.get_fdata(), 1e-6), mask=mask)
        both = mask & sure & (fit.evals[..., 2] > 0)
        fa, md = np.abs(ours["fa"] - fit.fa)[both], (np.abs(ours["md"] - fit.md) / np.maximum(fit.md, 1e-12))[both]
        add(name, "FA", "DIPY", np.median(fa), 5e-3, "(median)", "weights are not iterated there")
        add(name, "MD", "DIPY", np.median(md), 5e-3, "relative (median)")
        # DIPY leaves vectors in FSL's axes of the image.
        axes = image.affine[:3, :3]
        unit, _, vt = np.linalg.svd(axes)
        vectors = fit.directions[..., 0, :].copy()
        if np.linalg.det(axes) > 0:
            vectors[..., 0] *= -1
        vectors = vectors @ (unit @ vt).T
        a, b = ours["v1"][both], vectors[both]
        cosines = np.abs((a * b).sum(-1)) / np.maximum(np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1), 1e-30)
        add(name, "V1", "DIPY", np.degrees(np.arccos(np.clip(np.median(cosines), 0, 1))), 1.0, "degrees (median)")
    else:
        ABSENT.add("DIPY (python3-dipy)")
    add(name, "affine of V1", "nibabel", np.abs(own_vectors.affine - nib.load(path).affine).max(), 1e-4, "mm")


def points_of_tck(path):
    return [np.asarray(s) for s in nib.streamlines.load(path).streamlines]


def worst(lines, others):
    if len(lines) != len(others):
        return float("inf")
    return max((np.abs(a - b).max() if a.shape == b.shape else float("inf") for a, b in zip(lines, others)), default=0)


def points_of_trx(path):
    import json
    import zipfile
    with zipfile.ZipFile(path) as trx:
        header = json.loads(trx.read("header.json"))
        name = next(n for n in trx.namelist() if n.startswith("positions.3."))
        points = np.frombuffer(trx.read(name), name.rsplit(".", 1)[1]).reshape(-1, 3)
        name = next(n for n in trx.namelist() if n.startswith("offsets."))
        starts = np.frombuffer(trx.read(name), name.rsplit(".", 1)[1]).astype(int)
    if len(starts) == header["NB_STREAMLINES"]:
        starts = np.r_[starts, len(points)]
    return [points[a:b] for a, b in zip(starts[:-1], starts[1:])], np.array(header["VOXEL_TO_RASMM"])


def compare_tracts(dtmri, path, folder):
    name = os.path.basename(path)
    files = {e: os.path.join(folder, "own." + e) for e in ("tck", "trk", "trx")}
    run(dtmri, "trace", path, "--seeds", "fa:0.5", "--min-length", "10", "--out", files["tck"], "--force", "--quiet")
    for e in ("trk", "trx"):
        run(dtmri, "tracts", path, "--tracts", files["tck"], "--out", files[e], "--force", "--quiet")
    compare_files(name, path, files, folder)


def compare_files(name, path, files, folder):
    """The same lines in three formats, over the image at `path`."""
    lines = points_of_tck(files["tck"])
    note = f"{len(lines)} lines"
    trk = nib.streamlines.load(files["trk"])
    add(name, ".trk", "nibabel", worst(lines, [np.asarray(s) for s in trk.streamlines]), MOST_MM, "mm", note)
    add(name, "affine of .trk", "nibabel",
        np.abs(trk.header["voxel_to_rasmm"] - nib.load(path).affine).max(), 1e-3, "mm")
    points, affine = points_of_trx(files["trx"])
    add(name, ".trx", "the specification, by numpy", worst(lines, points), 0.0, "mm", note)
    add(name, "affine of .trx", "nibabel", np.abs(affine - nib.load(path).affine).max(), 1e-3, "mm")
    if TensorModel is None:
        ABSENT.add("DIPY (python3-dipy)")
    else:
        try:
            loaded = load_tractogram(files["trk"], path, bbox_valid_check=True)
            add(name, ".trk on its image", "DIPY", worst(lines, [np.asarray(s) for s in loaded.streamlines]), MOST_MM,
                "mm", "with the image as reference")
            loaded = load_tractogram(files["tck"], path, bbox_valid_check=True)
            add(name, ".tck on its image", "DIPY", worst(lines, [np.asarray(s) for s in loaded.streamlines]), MOST_MM,
                "mm", "with the image as reference")
        except Exception as error:  # what DIPY refuses is a row
            add(name, "tracts on their image", "DIPY", float("inf"), MOST_MM, "mm", str(error)[:80])
    if not shutil.which("tckinfo"):
        ABSENT.add("MRtrix (mrtrix3)")
    else:
        back = os.path.join(folder, "mrtrix.tck")
        run("tckinfo", files["tck"])
        run("tckedit", files["tck"], back, "-force", "-quiet")
        add(name, ".tck", "MRtrix", worst(lines, points_of_tck(back)), 0.0, "mm", "through tckedit")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    dtmri = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for stem in sys.argv[3:] if dtmri == "--tracts" else []:
            compare_files(os.path.basename(stem), sys.argv[2], {e: stem + "." + e for e in ("tck", "trk", "trx")}, folder)
        if dtmri == "--tracts":
            return report()
        series = sys.argv[2:] or [made_series(folder, order) for order in ("RAS", "LPS", "PIR")]
        for path in series:
            compare_images(dtmri, path, folder)
            compare_tracts(dtmri, path, folder)
    return report()


def report():
    print("| series | what | beside | largest difference | may be | is | |")
    print("|---|---|---|---|---|---|---|")
    for row in ROWS:
        print("| " + " | ".join(row) + " |")
    for program in sorted(ABSENT):
        print(f"\nNot installed: {program}.")
    return 0 if all(row[5] == "yes" for row in ROWS) else 1


sys.exit(main())
