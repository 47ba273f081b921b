"""A flying bird as VTK files, as ParaView reads them: an instant, or a series over time.

Blocks of a bird: wings, with circulation or what else colours them on the cells, edges, feathers,
bones, body, tail, forces (vectors in N at points), wake and path. Lengths in m, world axes.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.animation.scene import Scene
from birdmb.animation.stage import Stage
from birdmb.errors import OutputError
from birdmb.files import make_directory, write_whole

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkMultiBlockDataSet, vtkPolyData

_MISSING = (
    "files for ParaView are written by VTK, which is not installed: pip install 'birdmb[vtk]', or "
    "give a file that ends in .html or .gif."
)


def write_instant(stage: Stage, path: Path, phase: float) -> list[Path]:
    """Write the flight at a `phase` of the first beat, 0 to 1, as a multiblock file (.vtm).

    Raises:
        OutputError: VTK is not installed, or a file cannot be written.
    """
    _require_vtk()
    frame = round(phase * stage.scenes[0].frames_per_beat)
    return _write_frame(stage, path, frame)


def write_series(stage: Stage, path: Path) -> list[Path]:
    """Write the flight as a series of multiblock files and a list of them with times in s (.pvd).

    The times are those of the first bird. Raises as `write_instant`.
    """
    _require_vtk()
    folder = path.with_suffix("")
    make_directory(folder)
    pieces, entries = list[Path](), []
    for k, time in enumerate(stage.scenes[0].times.tolist()):
        name = folder / f"{path.stem}_{k:04}.vtm"
        pieces += _write_frame(stage, name, k)
        inside = quoteattr(f"{path.stem}/{name.name}")
        entries.append(f'    <DataSet timestep="{time:.9g}" part="0" file={inside}/>')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>'
    content = "\n".join([head, *entries, "  </Collection>", "</VTKFile>", ""])
    return [write_whole(path, content.encode()), *pieces]


def _require_vtk() -> None:
    try:
        import vtkmodules.vtkIOXML  # noqa: PLC0415, F401 - an extra
    except ImportError:
        raise OutputError(_MISSING) from None


def _write_frame(stage: Stage, path: Path, frame: int) -> list[Path]:
    """Write one frame; return the file, then those of its blocks."""
    from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataWriter  # noqa: PLC0415 - an extra

    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / path.name
        writer = vtkXMLMultiBlockDataWriter()
        writer.SetFileName(str(draft))
        writer.SetInputData(_blocks(stage, frame))
        if not writer.Write():
            raise OutputError(f"{path} cannot be written (VTK says no more).")
        made = sorted(each for each in draft.with_suffix("").iterdir() if each.is_file())
        # The list of the blocks comes last: it is whole only with them.
        blocks = path.with_suffix("")
        make_directory(blocks)
        beside = [write_whole(blocks / each.name, each.read_bytes()) for each in made]
        return [write_whole(path, draft.read_bytes()), *beside]


def _blocks(stage: Stage, frame: int) -> vtkMultiBlockDataSet:
    from vtkmodules.vtkCommonDataModel import (  # noqa: PLC0415 - an extra
        vtkCompositeDataSet,
        vtkMultiBlockDataSet,
    )

    whole = vtkMultiBlockDataSet()
    for i, scene in enumerate(stage.scenes):
        bird = vtkMultiBlockDataSet()
        for j, (name, block) in enumerate(_parts(stage, scene, frame)):
            bird.SetBlock(j, block)
            bird.GetMetaData(j).Set(vtkCompositeDataSet.NAME(), name)
        whole.SetBlock(i, bird)
        whole.GetMetaData(i).Set(vtkCompositeDataSet.NAME(), scene.title)
    return whole


def _parts(stage: Stage, scene: Scene, k: int) -> Iterator[tuple[str, vtkPolyData]]:
    colour = f"{scene.colour.name} ({scene.colour.unit})"
    chords = scene.chords[k]
    quads = np.concatenate([_quads(side, chords.shape[1]) for side in range(2)])
    wings = _surface(chords.reshape(-1, 3), quads)
    yield "wings", _with(wings, colour, scene.values[k].ravel(), of_cells=True)
    yield "edges", _polylines(scene.edges[k].reshape(-1, *scene.edges.shape[3:]))
    yield "feathers", _polylines(scene.feathers[k].reshape(-1, 2, 3))
    yield "bones", _polylines(scene.bones[k])
    yield "body", _surface(scene.body[k], scene.body_faces)
    if scene.tail is not None:
        yield "tail", _surface(scene.tail[k], np.array([[0, 1, 2]]))
    forces = _surface(scene.arrow_points[k], np.empty((0, 3), dtype=int))
    yield "forces", _with(forces, "force (N)", scene.arrow_forces[k], of_cells=False)
    lines, values = stage.wake(scene)
    known = ~np.isnan(lines[k, 0, :, 0])
    wake = _polylines(lines[k][:, known])
    yield "wake", _with(wake, colour, values[k][:, known].ravel(), of_cells=False)
    yield "path", _polylines(scene.path[None])


def _quads(side: int, borders: int) -> IntArray:
    inner = 2 * (side * borders + np.arange(borders - 1))
    return np.column_stack([inner, inner + 2, inner + 3, inner + 1])


def _surface(points: FloatArray, faces: IntArray) -> vtkPolyData:
    """Points (P, 3) with polygons (T, M) between them."""
    found = _points(points)
    found.SetPolys(_cells(faces))
    return found


def _polylines(lines: FloatArray) -> vtkPolyData:
    """Lines (L, P, 3)."""
    found = _points(lines.reshape(-1, 3))
    found.SetLines(_cells(np.arange(lines.shape[0] * lines.shape[1]).reshape(lines.shape[:2])))
    return found


def _points(points: FloatArray) -> vtkPolyData:
    from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: PLC0415 - an extra
    from vtkmodules.vtkCommonCore import vtkPoints  # noqa: PLC0415 - an extra
    from vtkmodules.vtkCommonDataModel import vtkPolyData  # noqa: PLC0415 - an extra

    found, places = vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    found.SetPoints(places)
    return found


def _cells(corners: IntArray) -> vtkCellArray:
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray  # noqa: PLC0415 - an extra
    from vtkmodules.vtkCommonDataModel import vtkCellArray  # noqa: PLC0415 - an extra

    count, size = corners.shape
    cells = vtkCellArray()
    offsets = np.arange(count + 1, dtype=np.int64) * size
    flat = np.ascontiguousarray(corners.ravel(), dtype=np.int64)
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(flat, deep=True)
    )
    return cells


def _with(data: vtkPolyData, name: str, values: FloatArray, *, of_cells: bool) -> vtkPolyData:
    from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: PLC0415 - an extra

    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes = data.GetCellData() if of_cells else data.GetPointData()
    attributes.AddArray(array)
    attributes.SetActiveVectors(name) if values.ndim > 1 else attributes.SetActiveScalars(name)
    return data
