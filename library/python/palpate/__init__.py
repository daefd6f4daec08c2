"""Lines of flow fields with their errors, exact where the field is linear by cells.

>>> import palpate
>>> field = palpate.example("abc")
>>> lines = palpate.trace(field, "random:3", max_length=5.0)
>>> len(lines), lines.method
(3, 'dp54')
>>> bool((lines.error < 1e-5 * field.diagonal).all())
True
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from . import _palpate
from ._palpate import (
    ENDS,
    ArrayInfo,
    Data,
    Error,
    Field,
    InputError,
    Lines,
    Scalar,
    UsageError,
    __version__,
    example,
    open,
    tetrahedra,
    trace,
    uniform,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

__all__ = [
    "ENDS",
    "ArrayInfo",
    "Data",
    "Error",
    "Field",
    "InputError",
    "Lines",
    "Scalar",
    "UsageError",
    "__version__",
    "each",
    "ends",
    "example",
    "open",
    "tetrahedra",
    "to_pyvista",
    "trace",
    "uniform",
]


def ends(lines: Lines) -> list[str]:
    """Why each line ends, in words."""
    return [ENDS[code] for code in lines.end_code]


def each(lines: Lines) -> Iterator[npt.NDArray[np.float64]]:
    """The points of one line after the other, shape (n, 3)."""
    for first, last in zip(lines.offsets[:-1], lines.offsets[1:]):
        yield lines.points[first:last]


def to_pyvista(lines: Lines) -> Any:
    """The lines as a pyvista.PolyData with time, speed and error by point, and the seed by line."""
    import numpy as np
    import pyvista  # type: ignore[import]

    counts = np.diff(lines.offsets)
    cells = np.insert(np.arange(lines.offsets[-1]), lines.offsets[:-1], counts)
    poly = pyvista.PolyData(np.asarray(lines.points), lines=cells)
    for name in ("time", "arc", "speed", "error"):
        poly.point_data[name] = getattr(lines, name)
    poly.cell_data["seed"] = lines.seed
    poly.cell_data["end"] = lines.end_code
    return poly
