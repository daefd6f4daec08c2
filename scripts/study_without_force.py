#!/usr/bin/env python3
"""study_without_force.py FLOW SEEDS [FIRST]: is the experiment able to say "no effect"?

Makes, simulates and analyses a small experiment of all four tasks for each of SEEDS seeds with the force set to zero
(`FLOW study make --guidance 0`), where both conditions are one, and asks whether the p values of the paired tests are
uniform (Kolmogorov and Smirnov, with Stephens' correction). docs/guide/study.md has what came of it.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = ["--participants", "8", "--practice", "0", "--recorded", "4", "--guidance", "0"]


def study(flow: str, *words: str) -> dict:
    done = subprocess.run([flow, "study", *words, "--json"], check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return json.loads(done.stdout)


def uniformity(values: list[float]) -> tuple[float, float]:
    n = len(values)
    distance = max(max((i + 1) / n - p, p - i / n) for i, p in enumerate(sorted(values)))
    x = (math.sqrt(n) + 0.12 + 0.11 / math.sqrt(n)) * distance
    p = 2 * sum((-1) ** (k - 1) * math.exp(-2 * k * k * x * x) for k in range(1, 101))
    return distance, min(1.0, max(0.0, p))


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    flow, seeds = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    found: dict[str, dict[str, list[float]]] = {"position error": {}, "completion time": {}}
    for seed in range(first, first + seeds):
        with tempfile.TemporaryDirectory() as folder:
            study(flow, "make", f"{folder}/s", "--seed", str(seed), *SIZE)
            study(flow, "simulate", f"{folder}/s")
            study(flow, "analyse", f"{folder}/s")
            report = json.loads(Path(folder, "s", "analysis", "report.json").read_text())
        for m in report["measurements"]:
            if m["parameter"] == "means, ISO - ANISO" and m["quantity"] == "p":
                found[m["subject"]].setdefault(m["method"], []).append(m["value"])
                print(seed, m["subject"], m["method"], m["value"], flush=True)
    for subject, tasks in found.items():
        for name, values in [*tasks.items(), ("all tasks", sum(tasks.values(), []))]:
            distance, p = uniformity(values)
            below = sum(value < 0.05 for value in values)
            print(f"{subject}, {name}: {len(values)} p values, D = {distance:.3f}, p = {p:.3f}, {below} below 0.05")


main()
