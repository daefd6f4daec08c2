"""python_wheel_test.py SOURCE BUILD: a wheel of what is built holds all that the module needs, and only once."""

import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

USE = """
import sys, numpy as np, palpate
assert palpate.__file__.startswith(sys.argv[1]), palpate.__file__
field = palpate.open(sys.argv[2]).vector()
lines = palpate.trace(field, [[0.5, 0.5, 0.5]])
assert lines.error.max() < 1e-3 and len(lines.points) > 1
maps = open("/proc/self/maps").read()
assert sys.argv[1] + "/palpate/libpalpate.so" in maps, "another library was loaded"
print(palpate.__version__)
"""

FLOW = """# vtk DataFile Version 3.0
made
ASCII
DATASET STRUCTURED_POINTS
DIMENSIONS 2 2 2
ORIGIN 0 0 0
SPACING 1 1 1
POINT_DATA 8
VECTORS velocity double
""" + 8 * "1 0.5 0.25\n"


def main() -> None:
    source, build = sys.argv[1:]
    sys.path.insert(0, f"{source}/scripts")
    import wheel_backend

    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PALPATE_HELPERS")}
    with tempfile.TemporaryDirectory() as folder:
        name = wheel_backend.build_wheel(folder, {"build": build})
        again = Path(folder, "again")
        again.mkdir()
        wheel_backend.build_wheel(again, {"build": build})
        assert Path(folder, name).read_bytes() == (again / name).read_bytes(), "two wheels of one build differ"
        place = Path(folder, "installed")
        with zipfile.ZipFile(Path(folder, name)) as wheel:
            assert wheel.testzip() is None
            for entry in wheel.infolist():
                wheel.extract(entry, place)
                os.chmod(place / entry.filename, entry.external_attr >> 16 & 0o777 or 0o644)
        flow = Path(folder, "flow.vtk")
        flow.write_text(FLOW)
        said = subprocess.run([sys.executable, "-c", USE, str(place), str(flow)], check=True, cwd=folder,
                              env={**environment, "PYTHONPATH": str(place)}, stdout=subprocess.PIPE, text=True).stdout
        assert f"palpate-{said.strip()}-" in name, (said, name)
        print(name, (Path(folder) / name).stat().st_size, "bytes")


main()
