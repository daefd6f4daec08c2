#!/usr/bin/env python3
"""scripts/guards_out.py [FOLDER]: takes every guard of lab/extremes/guards.tsv out of the program, one at a time, and writes to
lab/extremes/seen.def which rows of the catalogue of extreme cases then fail.

A guard is a line of guards.tsv: its name, a file, an expression that stands once in that file, and what takes its place,
between tabs; lines of one name belong together. Where it ends in a semicolon it is a statement, before which the other one is
done. A copy of the sources is built in FOLDER (build/guards), with a switch in place of each expression: the checkout never has
one, nor does any program that is built from it. The switch of a shader is a macro, which the compiler of shaders is given.
"""

import os
import pathlib
import resource
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CATALOGUE = ROOT / "lab/extremes"
SECONDS = 60  # of a processor, for the rows of one guard: a line without an end is a failure, too
# The kinds of rows that a guard is taken out for, by the folder of its file.
KINDS = (
    ("common/math/", "tensor"),
    ("common/field/tensor/", "tensor"),
    ("common/trace/tract/", "tensor"),
    ("common/field/", "field mesh"),
    ("common/trace/", "field mesh"),
    ("common/servo/", "device"),
    ("common/render/", "volume lens camera"),
    ("shaders/", "volume lens camera"),
)
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
# Where shaders are put together, and what stands there first.
ASSEMBLER = "common/render/gl/program.cpp"
NO_DEFINES = "  if (defines.empty()) return source;\n  std::string lines;\n"


def guards():
    for line in (CATALOGUE / "guards.tsv").read_text().splitlines():
        if line and not line.startswith("#"):
            yield [part.replace("\\n", "\n") for part in line.split("\t")]


def kinds_of(guard):
    of = {kinds for name, file, *_ in guards() if name == guard for folder, kinds in KINDS if file.startswith(folder)}
    return sorted(set(" ".join(of).split()))


def switched():
    """Each file that has a guard, with its switches."""
    texts, macros, asked = {}, {}, []
    for number, (name, file, text, instead) in enumerate(guards()):
        source = texts.get(file) or (ROOT / file).read_text()
        if source.count(text) != 1:
            sys.exit(f"{file}: `{text}` stands there {source.count(text)} times")
        if file.startswith("shaders/"):
            macro = f"PALPATE_GUARD_{number}"
            asked.append(f'  if (palpate_guard_out("{name}")) lines += "#define {macro}_OUT\\n";\n')
            head = f"#ifdef {macro}_OUT\n#define {macro} ({instead})\n#else\n#define {macro} ({text})\n#endif\n"
            macros[file] = macros.get(file, "") + head
            switch = macro
        elif text.endswith(";"):
            switch = f'if (palpate_guard_out("{name}")) {instead} {text}'
        else:
            switch = f'(palpate_guard_out("{name}") ? ({instead}) : ({text}))'
        texts[file] = source.replace(text, switch)
    for file, head in macros.items():
        first, rest = texts[file].split("\n", 1)
        texts[file] = f"{first}\n{head}{rest}" if first.startswith("#version") else f"{head}{texts[file]}"
    source = (ROOT / ASSEMBLER).read_text()
    if source.count(NO_DEFINES) != 1:
        sys.exit(f"{ASSEMBLER}: shaders are put together in another way")
    after = "  std::string lines;\n" + "".join(asked) + "  if (defines.empty() && lines.empty()) return source;\n"
    texts[ASSEMBLER] = source.replace(NO_DEFINES, after)
    for file, text in texts.items():
        if file.startswith("shaders/"):
            yield file, text
            continue
        head = "#pragma once\n" if "#pragma once\n" in text else ""
        yield file, text.replace(head, head + SWITCH, 1) if head else SWITCH + text


def failing(program, guard, kinds=()):
    """The rows that fail, without it; those that were not reached count where the program ended by a signal."""
    environment = dict(os.environ, PALPATE_GUARD_OUT=guard)
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))  # noqa: E731
    done = subprocess.run(
        [program, "--measure", *kinds], env=environment, capture_output=True, text=True, preexec_fn=limit, check=False
    )
    rows = [line.split("\t") for line in done.stdout.splitlines()]
    return {row[0]: row[1] for row in rows if row[-1] == "fails"}, len(rows)


def copy_to(copy):
    """The sources, with switches."""
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


def note(program):
    """Takes the guards out of this program, and writes what was seen."""
    wrong, count = failing(program, "")
    if wrong:
        sys.exit(f"with all guards these fail: {wrong}")
    seen = {}
    for guard in dict.fromkeys(name for name, *_ in guards()):
        rows, reached = failing(program, guard, kinds_of(guard))
        print(f"{guard}: {len(rows)} of {reached} rows fail", *(f"  {r}: {v}" for r, v in rows.items()), sep="\n", flush=True)
        for row in rows:
            seen.setdefault(row, guard)
    head = (CATALOGUE / "seen.def").read_text().splitlines()[0]
    lines = [f'PALPATE_SEEN("{row}", "{guard}")' for row, guard in sorted(seen.items())]
    (CATALOGUE / "seen.def").write_text("\n".join([head, *lines]) + "\n")
    print(f"{len(seen)} of {count} rows were seen to fail")


def main():
    copy = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/guards").resolve()
    if copy == ROOT:
        sys.exit("not into the checkout itself")
    copy_to(copy)
    subprocess.run(["cmake", "--preset", "release"], cwd=copy, check=True)
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", "extremes_page"], cwd=copy, check=True)
    note(copy / "build/release/lab/extremes_page")


if __name__ == "__main__":
    main()
