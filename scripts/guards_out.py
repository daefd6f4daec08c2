#!/usr/bin/env python3
"""scripts/guards_out.py [FOLDER]: takes every guard of lab/extremes/guards.tsv out of the program, one at a time, and writes to
lab/extremes/seen.def which rows of the catalogue of extreme cases then fail.

A guard is a line of guards.tsv: its name, a file, an expression that stands once in that file, and what takes its place,
between tabs; lines of one name belong together. A copy of the sources is built in FOLDER (build/guards), with a switch in
place of each expression: the checkout never has one, nor does any program that is built from it.
"""

import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CATALOGUE = ROOT / "lab/extremes"
SECONDS = 120  # for the rows of one guard: a line without an end is a failure, too
SWITCH = """#ifndef PALPATE_GUARD_OUT
#define PALPATE_GUARD_OUT
#include <cstdlib>
#include <cstring>
static bool palpate_guard_out(const char* name) noexcept {
  static const char* const out = std::getenv("PALPATE_GUARD_OUT");
  return out != nullptr && std::strcmp(out, name) == 0;
}
#endif
#line 1
"""


def guards():
    for line in (CATALOGUE / "guards.tsv").read_text().splitlines():
        if line and not line.startswith("#"):
            yield [part.replace("\\n", "\n") for part in line.split("\t")]


def switched():
    """Each file that has a guard, with its switches."""
    texts = {}
    for name, file, text, instead in guards():
        source = texts.get(file) or (ROOT / file).read_text()
        if source.count(text) != 1:
            sys.exit(f"{file}: `{text}` stands there {source.count(text)} times")
        texts[file] = source.replace(text, f'(palpate_guard_out("{name}") ? ({instead}) : ({text}))')
    for file, text in texts.items():
        head = "#pragma once\n" if "#pragma once\n" in text else ""
        yield file, text.replace(head, head + SWITCH, 1) if head else SWITCH + text


def failing(program, guard):
    """The rows that fail, without it; those that were not reached count where the program ended by a signal."""
    environment = dict(os.environ, PALPATE_GUARD_OUT=guard)
    try:
        done = subprocess.run([program, "--measure"], env=environment, timeout=SECONDS, capture_output=True, text=True)
        output = done.stdout
    except subprocess.TimeoutExpired as ended:
        output = (ended.stdout or b"").decode()
    rows = [line.split("\t") for line in output.splitlines()]
    return {row[0]: row[1] for row in rows if row[-1] == "fails"}, len(rows)


def main():
    copy = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/guards").resolve()
    if copy == ROOT:
        sys.exit("not into the checkout itself")
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    switches = dict(switched())
    for file in filter(None, tracked.split("\0")):
        if not (ROOT / file).is_file():
            continue
        to = copy / file
        to.parent.mkdir(parents=True, exist_ok=True)
        text = switches.get(file)
        if text is None:
            shutil.copy2(ROOT / file, to)
        elif not to.exists() or to.read_text() != text:
            to.write_text(text)
    subprocess.run(["cmake", "--preset", "release"], cwd=copy, check=True)
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", "extremes_page"], cwd=copy, check=True)
    program = copy / "build/release/lab/extremes_page"
    wrong, count = failing(program, "")
    if wrong:
        sys.exit(f"with all guards these fail: {wrong}")
    seen = {}
    for guard in dict.fromkeys(name for name, *_ in guards()):
        rows, reached = failing(program, guard)
        print(f"{guard}: {len(rows)} of {reached} rows fail", *(f"  {r}: {v}" for r, v in rows.items()), sep="\n", flush=True)
        for row in rows:
            seen.setdefault(row, guard)
    head = (CATALOGUE / "seen.def").read_text().splitlines()[0]
    lines = [f'PALPATE_SEEN("{row}", "{guard}")' for row, guard in sorted(seen.items())]
    (CATALOGUE / "seen.def").write_text("\n".join([head, *lines]) + "\n")
    print(f"{len(seen)} of {count} rows were seen to fail")


main()
