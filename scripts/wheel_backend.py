"""Builds a wheel of the Python module with CMake (pyproject.toml names this file; PEP 517).

The package folder has all: the module, the library beside it, and the programs that read files. With the setting
`build` (`pip wheel . --config-settings build=build/release`) an existing build folder is used in place of build/wheel.
"""

import base64
import hashlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def project(pattern):
    return re.search(pattern, (ROOT / "CMakeLists.txt").read_text()).group(1)


VERSION = project(r"project\(palpate VERSION (\S+)")
DESCRIPTION = project(r'DESCRIPTION "([^"]+)"')


def cmake(*words):
    subprocess.run(["cmake", *map(str, words)], check=True, stdout=sys.stderr)


def package_files(build, stage):
    """Names in the package and the files behind them."""
    for component in ("python3-palpate", "libpalpate"):
        cmake("--install", build, "--prefix", stage, "--component", component)
    files = {}
    for file in sorted(stage.rglob("*")):
        if file.parent.name == "palpate" or re.fullmatch(r"libpalpate\.so\.\d+\.\d+", file.name):
            if file.is_file():
                files[file.name] = file
    for file in sorted((build / "lib" / "palpate").glob("palpate-load-*")):
        files[file.name] = file
    return files


def metadata():
    return (
        f"Metadata-Version: 2.1\nName: palpate\nVersion: {VERSION}\nSummary: {DESCRIPTION}\n"
        "Requires-Python: >=3.11\nRequires-Dist: numpy\n"
    )


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = (config_settings or {}).get("build")
    if build is None:
        build = ROOT / "build" / "wheel"
        cmake("-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", f"-DPython_EXECUTABLE={sys.executable}")
    build = Path(build).resolve()
    cmake("--build", build, "--target", "palpate_python")
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    name = f"palpate-{VERSION}-{tag}.whl"
    record = []
    with tempfile.TemporaryDirectory() as stage, zipfile.ZipFile(
        Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED
    ) as wheel:

        def write(path, data, mode=0o644):
            entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))  # the same files make the same wheel
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)

        def add(path, data, mode=0o644):
            write(path, data, mode)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(data)}")

        for file, source in package_files(build, Path(stage)).items():
            add(f"palpate/{file}", source.read_bytes(), 0o755 if file.startswith("palpate-load-") else 0o644)
        info = f"palpate-{VERSION}.dist-info"
        add(f"{info}/METADATA", metadata().encode())
        add(
            f"{info}/WHEEL",
            f"Wheel-Version: 1.0\nGenerator: palpate\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(),
        )
        record.append(f"{info}/RECORD,,")
        write(f"{info}/RECORD", "\n".join(record) + "\n")
    return name
