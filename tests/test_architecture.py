"""Who may import whom: read from the sources, so that it holds for imports that no test runs."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# Each may import those before it; `orbits` no bird, whatever stands before it.
FOUNDATIONS = {
    *(
        "_boxing",
        "_kernel_files",
        "_kernels",
        "_linked",
        "_starting",
        "_typing",
        "datafiles",
        "arguments",
        "errors",
        "files",
        "provenance",
        "quantities",
        "seal",
    ),
    *("summary", "text", "threads"),
}
ROOMS = (
    *("topology", "morphology", "wing", "aerodynamics", "kinematics", "orbits", "models"),
    *("studies", "figures", "animation", "reproduction", "cli"),
)
BIRDS = {
    *("topology", "morphology", "wing", "aerodynamics", "kinematics", "models", "studies"),
}

DRAWING = (
    *("matplotlib.", "plotly.", "vtkmodules."),
    *("birdmb.figures.", "birdmb.animation.", "birdmb.reproduction.figures."),
)
# What calls of `plot` and `animate` return.
_RETURNED = {"matplotlib.figure", "birdmb.animation.animation"}


@dataclass(frozen=True)
class Import:
    """One import; `within` are the functions around it, `typing` whether only mypy follows it."""

    module: str
    target: str
    within: tuple[str, ...]
    typing: bool

    @property
    def draws(self) -> bool:
        return f"{self.target}.".startswith(DRAWING)

    @property
    def is_lazy_drawing(self) -> bool:
        return self.draws and self.within[-1:] in {("plot",), ("animate",)}


def modules() -> dict[str, Path]:
    paths = (ROOT / "birdmb").rglob("*.py")
    return {name_of(path): path for path in paths}


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def sources(path: Path) -> Iterator[Path]:
    """A module with the list of the names that it imports at their first use."""
    yield path
    if path.with_suffix(".pyi").exists():
        yield path.with_suffix(".pyi")


def imports_of(module: str, path: Path, known: dict[str, Path]) -> Iterator[Import]:
    package = module if path.stem == "__init__" else module.rpartition(".")[0]

    def absolute(node: ast.ImportFrom) -> str:
        parents = package.split(".")[: len(package.split(".")) - node.level + 1]
        return ".".join([*(parents if node.level else []), *filter(None, [node.module])])

    def visit(node: ast.AST, within: tuple[str, ...], typing: bool) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            yield from (Import(module, alias.name, within, typing) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            source = absolute(node)
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                target = inner if inner in known or source == "birdmb" else source
                yield Import(module, target, within, typing)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            within = (*within, node.name)
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            typing = True
        for child in ast.iter_child_nodes(node):
            yield from visit(child, within, typing)

    lazily = ("__getattr__",) if path.suffix == ".pyi" else ()
    yield from visit(ast.parse(path.read_text(encoding="utf-8")), lazily, False)


def room(module: str) -> str:
    """The package or module right within birdmb that a module belongs to."""
    return module.split(".")[1] if "." in module else ""


@pytest.fixture(scope="module")
def imports() -> list[Import]:
    known = modules()
    return [
        found
        for module, path in known.items()
        for source in sources(path)
        for found in imports_of(module, source, known)
    ]


@pytest.fixture(scope="module")
def own(imports) -> list[Import]:
    """Those of birdmb's own modules, apart from calls that draw, which import what they call."""
    # What they return is known by its type alone.
    return [
        i
        for i in imports
        if i.target.startswith("birdmb")
        and not i.is_lazy_drawing
        and not (i.typing and i.target in _RETURNED)
    ]


def test_the_sources_are_read(imports):
    assert {room(i.module) for i in imports} >= {*ROOMS, "files"}
    assert any(i.is_lazy_drawing for i in imports)
    assert any(i.typing for i in imports)


def test_only_figures_and_the_command_lines_draw(imports):
    drawing = {"figures", "animation", "cli", ""}
    pictures = ("birdmb.reproduction.figures", "birdmb.reproduction.__main__")
    others = [
        i
        for i in imports
        if i.draws and room(i.module) not in drawing and not i.module.startswith(pictures)
    ]
    assert [i for i in others if not i.typing and not i.is_lazy_drawing] == []
    assert [i for i in others if i.typing and i.target not in _RETURNED] == []


def test_no_modules_import_each_other(own):
    """Not within functions or for types either: there, a circle is hidden, not opened."""
    graph: dict[str, set[str]] = {}
    for found in own:
        if found.target != found.module:
            graph.setdefault(found.module, set()).add(found.target)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(reversed(error.args[1])))


def test_orbits_know_nothing_of_birds(own):
    assert [i for i in own if room(i.module) == "orbits" and room(i.target) in BIRDS] == []


def test_dependencies_run_one_way(own):
    rank = dict.fromkeys(FOUNDATIONS, -1) | {name: i for i, name in enumerate(ROOMS)}
    inside = [i for i in own if room(i.module) not in {"", "__main__"}]
    unknown = {room(i.module) for i in inside} - rank.keys()
    assert not unknown, "new in birdmb: say here what it may import"
    # `birdmb` itself is the list of what users take, from all rooms but the last.
    assert [i for i in inside if rank[room(i.module)] < rank.get(room(i.target), rank["cli"])] == []


def test_nothing_but_the_command_line_knows_of_the_thesis(imports):
    knowing = [i for i in imports if room(i.target) == "reproduction"]
    assert {room(i.module) for i in knowing} == {"reproduction", "cli"}
