"""Lines of flow fields with their errors, exact where the field is linear by cells; what a hand
feels in them; tensors and tracts.

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
    STATES,
    ArrayInfo,
    Chain,
    Data,
    Device,
    Drag,
    Error,
    Field,
    Flow,
    InputError,
    Isosurface,
    Lines,
    Link,
    Plane,
    Potential,
    Scalar,
    Servo,
    ServoNow,
    Slicer,
    Streamline,
    Tensors,
    Touch,
    Tracts,
    UsageError,
    __version__,
    chain_settings,
    example,
    example_tensors,
    fit_tensors,
    layers,
    open,
    open_tensors,
    render,
    scalar,
    tetrahedra,
    trace,
    tracts,
    uniform,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

__all__ = [
    "ENDS",
    "STATES",
    "ArrayInfo",
    "Chain",
    "Data",
    "Device",
    "Drag",
    "Error",
    "Field",
    "Flow",
    "InputError",
    "Isosurface",
    "Lines",
    "Link",
    "Plane",
    "Potential",
    "Scalar",
    "Servo",
    "ServoNow",
    "Slicer",
    "Streamline",
    "Tensors",
    "Touch",
    "Tracts",
    "UsageError",
    "__version__",
    "chain_settings",
    "each",
    "ends",
    "example",
    "example_tensors",
    "fit_tensors",
    "layers",
    "open",
    "open_tensors",
    "render",
    "scalar",
    "states",
    "tetrahedra",
    "to_dipy",
    "to_nibabel",
    "to_pyvista",
    "trace",
    "tracts",
    "uniform",
]


def ends(lines: Lines) -> list[str]:
    """Why each line ends, in words."""
    return [ENDS[code] for code in lines.end_code]


def states(touch: Touch) -> list[str]:
    """What the chain did at each point of its path, in words.

    >>> import numpy as np, palpate
    >>> chain = palpate.Chain([palpate.Plane([0, 0, 0], [0, 0, 1])], scale=1.0)
    >>> touch = chain.run([[0, 0, 0.001], [0, 0, -0.001]])
    >>> palpate.states(touch), touch.proxies[1, 0].tolist()
    (['free', 'held'], [0.0, 0.0, 0.0])
    """
    return [STATES[code] for code in touch.state_code]


def each(lines: Lines | Tracts) -> Iterator[npt.NDArray[Any]]:
    """The points of one line after the other, shape (n, 3)."""
    points = lines.points
    for first, last in zip(lines.offsets[:-1].tolist(), lines.offsets[1:].tolist()):
        yield points[first:last]


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


def to_nibabel(tracts: Tracts) -> Any:
    """The tracts as a nibabel.streamlines.Tractogram with the error by point and the seed by line."""
    import nibabel  # type: ignore[import]
    import numpy as np

    offsets = tracts.offsets.tolist()
    errors = [tracts.error[first:last, None] for first, last in zip(offsets[:-1], offsets[1:])]
    return nibabel.streamlines.Tractogram(
        list(each(tracts)),
        data_per_streamline={"seed": tracts.seed[:, None]},
        data_per_point={"error": errors},
        affine_to_rasmm=np.eye(4),
    )


def to_dipy(tracts: Tracts, tensors: Tensors) -> Any:
    """The tracts as a StatefulTractogram of DIPY, in the space of the image that they were traced in."""
    import nibabel
    import numpy as np
    from dipy.io.stateful_tractogram import Space, StatefulTractogram  # type: ignore[import]

    nz, ny, nx = tensors.values.shape[:3]
    reference = nibabel.Nifti1Image(np.zeros((nx, ny, nz), dtype=np.uint8), tensors.affine)
    return StatefulTractogram(list(each(tracts)), reference, Space.RASMM)
