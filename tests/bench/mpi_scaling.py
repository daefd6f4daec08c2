"""Lines over ranks on a synthetic field that stays on the disk: same bits, processor time, bytes, rounds, and a model.

  mpi_scaling.py PALPATE_MPI MPIRUN FOLDER [POINTS] [SEEDS]

Weak scaling: seeds in proportion to the ranks. The model is fitted to 1, 2 and 4 ranks and held against 8:

  processor time of a line = c + m s,    m(P) = a (1 - 1/P)

c the tracing, m the moves of a line from rank to rank, s the time of a move (to write, send and read its state). Of P ranks a line
that is dealt out anew comes to another one with the probability 1 - 1/P, where places are as good as random: an upper bound,
since lines in one block stay together. Rounds do not depend on P, as each rank has as many lines.
"""

import json
import math
import os
import pathlib
import subprocess
import sys

import numpy as np

MPI, MPIRUN, FOLDER = sys.argv[1:4]
POINTS = int(sys.argv[4]) if len(sys.argv) > 4 else 512
SEEDS = int(sys.argv[5]) if len(sys.argv) > 5 else 250
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1"}
folder = pathlib.Path(FOLDER)
volume = folder / f"abc{POINTS}.nrrd"


def write_field():
    """The ABC flow, a slice at a time."""
    h = 2.0 * math.pi / (POINTS - 1)
    header = (f"NRRD0004\ntype: float\ndimension: 4\nsizes: 3 {POINTS} {POINTS} {POINTS}\nencoding: raw\nendian: little\n"
              "kinds: vector domain domain domain\nspace dimension: 3\n"
              f"space directions: none ({h!r},0,0) (0,{h!r},0) (0,0,{h!r})\nspace origin: (0,0,0)\n")
    header += "#" * (2 + -len(header) % 4) + "\n\n"
    axis = h * np.arange(POINTS)
    y, x = np.meshgrid(axis, axis, indexing="ij")
    a, b, c = math.sqrt(3.0), math.sqrt(2.0), 1.0
    with open(volume, "wb") as out:
        out.write(header.encode())
        for z in axis:
            part = np.stack([a * np.sin(z) + c * np.cos(y), b * np.sin(x) + a * np.cos(z), c * np.sin(y) + b * np.cos(x)], -1)
            out.write(part.astype("<f4").tobytes())


def trace(ranks, seeds, name):
    out = folder / name
    done = subprocess.run([MPIRUN, "-n", str(ranks), MPI, "trace", str(volume), "--seeds", f"random:{seeds}", "--out", str(out),
                           "--blocks", "64", "--round-pieces", "100000", "--json", "--force", "--quiet"],
                          capture_output=True, text=True, env=ENVIRONMENT)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout), out


if not volume.exists():
    write_field()
rows = []
for ranks in (1, 2, 4, 8):
    figures, _ = trace(ranks, SEEDS * ranks, "weak.vtp")
    lines = figures["lines"]
    rows.append({"ranks": ranks, "cpu": sum(figures["cpu_seconds_tracing"]) / lines, "moves": figures["lines_moved"] / lines,
                 "bytes": figures["bytes_sent"] / max(1, figures["lines_moved"]), "rounds": figures["rounds"],
                 "most": max(figures["cpu_seconds_tracing"]) * ranks / sum(figures["cpu_seconds_tracing"]),
                 "all": sum(figures["cpu_seconds"])})
    print("%(ranks)d ranks: %(cpu).4f s of processor time a line, %(moves).2f moves of %(bytes).0f bytes a line, %(rounds)d rounds, "
          "the busiest rank %(most).2f of the mean; %(all).1f s with reading and writing" % rows[-1])
base = rows[0]["cpu"]
few = rows[1:3]
a = np.mean([row["moves"] / (1 - 1 / row["ranks"]) for row in few])
slope = np.mean([(row["cpu"] - base) / row["moves"] for row in few if row["moves"] > 0])


def model(ranks):
    return base + slope * a * (1 - 1 / ranks)


print("from 1 to 8 ranks: %.3f times the processor time of a line; model for 8: %.4f s, measured %.4f s (%+.1f %%)" %
      (rows[-1]["cpu"] / base, model(8), rows[-1]["cpu"], 100 * (model(8) / rows[-1]["cpu"] - 1)))
LATENCY, BANDWIDTH = 5e-6, 1e9  # [s] of a message, [bytes/s] of a rank: taken, not measured
for ranks in (8, 64, 512, 4096):
    moved = a * (1 - 1 / ranks) * SEEDS * rows[-1]["bytes"]
    calls = rows[-1]["rounds"] * (4 * math.log2(ranks) * LATENCY + ranks * LATENCY + 64 * 8 * 2 / BANDWIDTH * math.log2(ranks))
    seconds = model(ranks) * SEEDS * rows[-1]["most"] + calls + moved / BANDWIDTH
    print("%d ranks, %d seeds: %.2f s, of which %.3f s of calls and %.4f s of bytes" %
          (ranks, SEEDS * ranks, seconds, calls, moved / BANDWIDTH))
