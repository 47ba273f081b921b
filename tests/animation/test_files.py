"""Pages, films and files for ParaView: whole, moving, and read back."""

import html.parser
import itertools
import re
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image

import birdmb
from birdmb.errors import OutputError


@pytest.fixture(scope="module")
def moving(tail_cycle):
    return tail_cycle.animate(beats=1, frames=8)


class Resources(html.parser.HTMLParser):
    """Collects what a page would load: tags with an address, and the text of styles."""

    def __init__(self):
        super().__init__()
        self.addresses, self.styles, self._within = [], [], ""

    def handle_starttag(self, tag, attrs):
        self._within = tag
        self.addresses += [value for name, value in attrs if name in {"src", "href", "srcset"}]

    def handle_data(self, data):
        if self._within == "style":
            self.styles.append(data)


def test_a_page_holds_all_that_it_needs(moving, tmp_path):
    (path,) = moving.save(tmp_path / "flight.html")
    text = path.read_text(encoding="utf-8")
    found = Resources()
    found.feed(text)
    assert found.addresses == []
    assert found.styles
    assert not any(re.search(r"url\(|@import", style) for style in found.styles)
    assert "ibis_tail, rigid model" in text
    assert len(text) < 10e6


def test_the_largest_usual_page_stays_below_ten_megabytes(tail_cycle):
    assert len(tail_cycle.animate(tail_cycle).page) < 10e6


def test_frames_bring_only_what_changes(moving):
    figure = moving.figure
    assert len(figure.frames) == 9
    first, fixed = figure.frames[0], figure.data
    for trace, index in zip(first.data, first.traces, strict=True):
        assert trace.i is None if trace.type == "mesh3d" else True
        assert trace.hovertemplate is None
        assert fixed[index].type == trace.type
    assert len(first.traces) < len(fixed)


def test_lengths_are_true_to_scale(moving):
    scene = moving.figure.layout.scene
    sides = [np.ptp(getattr(scene, f"{axis}axis").range) for axis in "xyz"]
    ratio = [getattr(scene.aspectratio, axis) for axis in "xyz"]
    np.testing.assert_allclose(np.divide(sides, ratio), sides[0] / ratio[0])


def test_a_notebook_shows_the_page_in_a_frame(moving):
    shown = moving._repr_html_()
    assert shown.startswith("<iframe")
    assert "srcdoc" in shown
    assert "<script" not in shown  # escaped: it is the frame's, not the notebook's


def test_a_gif_moves(tail_cycle, tmp_path):
    (path,) = tail_cycle.animate(tail_cycle, beats=1, frames=8).save(tmp_path / "flight.gif")
    with Image.open(path) as film:
        assert film.n_frames == 8
        pictures = []
        for k in range(film.n_frames):
            film.seek(k)
            pictures.append(np.asarray(film.convert("RGB"), dtype=int))
    for one, other in itertools.pairwise(pictures):
        assert (np.abs(one - other).max(axis=2) > 30).mean() > 1e-3


def test_an_mp4_is_a_film(moving, tmp_path):
    pytest.importorskip("imageio_ffmpeg")
    (path,) = moving.save(tmp_path / "flight.mp4")
    assert path.read_bytes()[4:8] == b"ftyp"


def test_without_ffmpeg_a_sentence_says_what_to_do(moving, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda _: False))
    with pytest.raises(OutputError, match=r"birdmb\[movie\].*\.gif"):
        moving.save(tmp_path / "flight.mp4")
    assert list(tmp_path.iterdir()) == []


def test_without_vtk_a_sentence_says_what_to_do(moving, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "vtkmodules.vtkIOXML", None)
    with pytest.raises(OutputError, match=r"birdmb\[vtk\]"):
        moving.save(tmp_path / "flight.vtm")
    with pytest.raises(OutputError, match=r"birdmb\[vtk\]"):
        moving.save(tmp_path / "flight.pvd")
    assert list(tmp_path.iterdir()) == []


def blocks_of(path):
    """Blocks of the first bird in a multiblock file, by name."""
    io = pytest.importorskip("vtkmodules.vtkIOXML")
    model = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    reader = io.vtkXMLMultiBlockDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    bird = reader.GetOutput().GetBlock(0)
    name = model.vtkCompositeDataSet.NAME()
    return {
        bird.GetMetaData(i).Get(name): bird.GetBlock(i) for i in range(bird.GetNumberOfBlocks())
    }


def test_an_instant_for_paraview_reads_back(moving, tmp_path):
    vtk_to_numpy = pytest.importorskip("vtkmodules.util.numpy_support").vtk_to_numpy
    path, *beside = moving.save(tmp_path / "flight.vtm", phase=0.5)
    assert {each.parent for each in beside} == {tmp_path / "flight"}
    blocks, (scene,) = blocks_of(path), moving.scenes
    assert set(blocks) == {
        *("wings", "edges", "feathers", "bones", "body", "tail", "forces", "wake", "path"),
    }
    wings = blocks["wings"]
    points = vtk_to_numpy(wings.GetPoints().GetData())
    np.testing.assert_allclose(points, scene.chords[4].reshape(-1, 3), atol=1e-12)
    values = vtk_to_numpy(wings.GetCellData().GetArray("circulation (m²/s)"))
    np.testing.assert_allclose(values, scene.values[4].ravel(), atol=1e-12)
    assert wings.GetNumberOfCells() == scene.values[4].size
    forces = vtk_to_numpy(blocks["forces"].GetPointData().GetArray("force (N)"))
    np.testing.assert_allclose(forces, scene.arrow_forces[4], atol=1e-12)


def test_a_series_for_paraview_names_its_files_and_times(moving, tmp_path):
    pytest.importorskip("vtkmodules")
    path, *_ = moving.save(tmp_path / "flight.pvd")
    entries = ET.parse(path).getroot().findall(".//DataSet")
    (scene,) = moving.scenes
    times = [float(each.get("timestep")) for each in entries]
    np.testing.assert_allclose(times, scene.times, atol=1e-8)
    files = [tmp_path / each.get("file") for each in entries]
    assert all(each.is_file() for each in files)
    first, last = (blocks_of(files[k])["body"].GetBounds() for k in (0, -1))
    flown = scene.path[-1, 0] - scene.path[0, 0]
    assert last[0] - first[0] == pytest.approx(flown, abs=1e-3)


def test_an_ending_that_means_nothing_is_refused(moving, tmp_path):
    with pytest.raises(birdmb.ArgumentError, match=r"\.html.*\.gif.*\.pvd"):
        moving.save(tmp_path / "flight.mov")
    with pytest.raises(birdmb.ArgumentError, match="phase must be from 0 to 1"):
        moving.save(tmp_path / "flight.vtm", phase=2.0)
