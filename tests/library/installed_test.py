"""The examples of library/examples, built by CMake and by pkg-config against the installed package alone, and run."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

source, build = map(pathlib.Path, sys.argv[1:3])
examples = sorted((source / "library/examples").glob("*.cpp"))
assert len(examples) >= 5, examples


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=600, **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}"
    return done.stdout


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    prefix = folder / "prefix"
    for component in ("libpalpate", "libpalpate-dev"):
        run("cmake", "--install", build, "--prefix", prefix, "--component", component)
    project = folder / "project"
    project.mkdir()
    for example in examples:
        shutil.copy(example, project)
    lists = ["cmake_minimum_required(VERSION 3.25)", "project(examples LANGUAGES CXX)", "find_package(Palpate REQUIRED)"]
    for example in examples:
        lists += [f"add_executable({example.stem} {example.name})",
                  f"target_link_libraries({example.stem} PRIVATE Palpate::palpate)"]
    (project / "CMakeLists.txt").write_text("\n".join(lists))
    run("cmake", "-S", project, "-B", folder / "made", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", folder / "made")
    libraries = next(prefix.glob("lib/**/libpalpate.so")).parent
    for example in examples:
        said = run(folder / "made" / example.stem, cwd=folder, env={**os.environ, "LD_LIBRARY_PATH": str(libraries)})
        print(said, end="")
        assert said.strip(), example
    # The same by pkg-config, which finds the prefix from where its file lies.
    flags = run("pkg-config", "--cflags", "--libs", "palpate",
                env={**os.environ, "PKG_CONFIG_PATH": str(libraries / "pkgconfig")}).split()
    run("g++", "-std=c++20", examples[-1], *flags, "-o", folder / "by_hand")
