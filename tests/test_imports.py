"""What may import what, and what a command pays for."""

import ast
import json
import os
import pickle
import random
import re
import secrets
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from sources import calls_of, nodes_of, paths, tree_of

import verify
from verify.asleep import randbits

PACKAGE = Path(verify.__file__).parent
MODELS = ("exact", "elements", "segments")
ROOMS = (
    "values",
    "models",
    *MODELS,
    "contact",
    "judge",
    "waves",
    "motion",
    "chain",
    "motor",
    "scenes",
    "quantities",
    "studies",
    "peers",
    "bench",
    "run",
    "identify",
    "stress",
    "report",
    "exports",
    "pictures",
    "faces",
    "commands",
    "doors",
)
"""From the ground up: a room imports from those before it; the three models from none of each other."""
COMPILER = "models.kernels"
LIST = Path(__file__).parent / "identify" / "data" / "exudyn-cantilever.csv"
DOORS = {"__init__", "__main__", "cli", "pytest_plugin"}
FACES = {"analytic_modes", "fem_beam", "segment_model", "simulate", "travelling_wave"}


def modules():
    """(dotted name below verify, path) of everything that is compiled."""
    for path in sorted(PACKAGE.rglob("*.py")):
        yield ".".join(path.relative_to(PACKAGE).with_suffix("").parts), path


def room_of(name):
    """The room that a module lies in: values, faces and doors lie side by side in the hall."""
    first, _, rest = name.partition(".")
    hall = "doors" if first in DOORS else "faces" if first in FACES else "values"
    return first if rest or (PACKAGE / first).is_dir() else hall


def for_typing(path):
    """Nodes of a file that stand in its `if TYPE_CHECKING`, by their ids."""
    heads = [n for n in nodes_of(path) if isinstance(n, ast.If) and getattr(n.test, "id", "") == "TYPE_CHECKING"]
    return {id(node) for head in heads for body in head.body for node in ast.walk(body)}


@cache
def imports_of(path, *, typing_too=False):
    """Dotted names below verify that a file imports anywhere, but for typing alone."""
    left = set() if typing_too else for_typing(path)
    found = set()
    for node in nodes_of(path):
        if id(node) in left:
            continue
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "verify":
            under = node.module.partition(".")[2]
            found |= {f"{under}.{a.name}".strip(".") for a in node.names} if is_package(under) else {under}
        elif isinstance(node, ast.Import):
            found |= {a.name.partition(".")[2] for a in node.names if a.name.startswith("verify.")}
    return {name for name in found if (PACKAGE / f"{name.replace('.', '/')}.py").exists() or is_package(name)}


def is_package(name):
    return (PACKAGE / name.replace(".", "/")).is_dir()


def test_every_room_is_known_and_says_what_it_is_for():
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert rooms == {path.parent.name for path in PACKAGE.glob("*/*.py")}
    assert rooms == set(ROOMS) - {"values", "faces", "doors"}
    for room in rooms:
        said = ast.get_docstring(ast.parse((PACKAGE / room / "__init__.py").read_text("utf-8")))
        assert said, room
        assert len(said.splitlines()) >= 3, f"{room} says too little of what it takes and gives, and who may call it"


@pytest.mark.parametrize("name", [name for name, _ in modules()])
def test_a_room_imports_from_rooms_below_it_alone(name):
    own = room_of(name)
    for imported in imports_of(PACKAGE / f"{name.replace('.', '/')}.py"):
        there = room_of(imported)
        assert there == own or ROOMS.index(there) < ROOMS.index(own), f"{name} imports {imported}, not below it"


@pytest.mark.parametrize("model", MODELS)
def test_a_model_knows_no_other_model_and_no_judge(model):
    """Not even for typing: their agreement is evidence between independent modes, loads and readings."""
    for path in (PACKAGE / model).glob("*.py"):
        assert {room_of(name) for name in imports_of(path, typing_too=True)} <= {"values", "models", model}, path.name


NAMES_OTHERS = {("models.kind", "models.catalogue")}
"""(who, whom): a model without a verb asks who else has it, to say so."""


def test_no_modules_stand_in_a_circle():
    """Wherever they import each other, at their top or in a function, but for typing alone."""
    left = {name: imports_of(path) for name, path in modules()}
    left = {name: {one for one in its if (name, one) not in NAMES_OTHERS} for name, its in left.items()}
    while ground := {name for name, its in left.items() if not its & set(left)}:
        left = {name: its for name, its in left.items() if name not in ground}
    assert not left, f"these import each other in circles, or stand on such: {sorted(left)}"


def test_nothing_inside_stands_on_a_face():
    for name, path in modules():
        assert name in FACES or not {room_of(one) for one in imports_of(path)} & {"faces"}, name


def test_closed_forms_take_the_beam_alone():
    assert imports_of(PACKAGE / "exact" / "closed_forms.py", typing_too=True) == {"beam", "checks", "errors", "options"}


def test_numba_is_imported_by_one_module_and_used_by_kernels_alone():
    sources = {name: path.read_text("utf-8") for name, path in modules()}
    assert {name for name, text in sources.items() if "numba import" in text or "import numba" in text} == {COMPILER}
    users = {name for name, path in modules() if COMPILER in imports_of(path)}
    assert len(users) > 3
    assert users == {name for name in sources if name.endswith("kernels")} - {COMPILER}


def test_kernels_import_from_what_their_stamp_covers():
    """Kernels and records: an edit elsewhere would leave what is compiled on disk as it was."""
    for name, path in modules():
        if name.endswith(("kernels", "records")) and name != COMPILER:
            there = {one for one in imports_of(path, typing_too=True) if not one.endswith(("kernels", "records"))}
            assert there <= {"models.arrays"}, name


def test_an_edit_of_kernels_in_a_room_that_others_import_from_changes_the_stamp_of_those(tmp_path):
    from verify.models.kernels import room_stamp

    for room, line in (("low", "x = 1"), ("high", "from verify.low.a_kernels import x"), ("apart", "y = 1")):
        (tmp_path / room).mkdir()
        (tmp_path / room / "a_kernels.py").write_text(line)
    before = {room: room_stamp(tmp_path / room) for room in ("low", "high", "apart")}
    (tmp_path / "low" / "a_kernels.py").write_text("x = 2")
    room_stamp.cache_clear()
    after = {room: room_stamp(tmp_path / room) for room in ("low", "high", "apart")}
    assert [before[room] == after[room] for room in ("low", "high", "apart")] == [False, False, True]


def test_what_steps_a_slider_is_loaded_where_something_steps():
    """In functions, which only stepping calls: planning and closed forms do without a compiler."""
    slow = {name for name, _ in modules() if name.startswith(("motion.", "motor.")) and name.endswith("kernels")}
    for name, path in modules():
        if name.endswith("kernels"):
            continue
        lines = [node for node in tree_of(path).body if isinstance(node, ast.ImportFrom)]
        at_the_top = {f"{node.module}.{a.name}" for node in lines for a in node.names} | {n.module for n in lines}
        assert name in slow or not at_the_top & {f"verify.{one}" for one in slow}, name


def test_scikit_fem_is_imported_by_the_finite_elements_alone():
    users = {room_of(name) for name, path in modules() if re.search(r"\b(from|import) skfem", path.read_text("utf-8"))}
    assert users == {"elements"}


def test_nothing_below_the_command_line_prints():
    for path in paths():
        assert not calls_of(path, "print"), path.name


def loaded_by(*words):
    """Top-level modules loaded after a command line ran in a fresh process."""
    code = (
        "import sys, json, io, contextlib\nfrom verify.cli import status_of\n"
        "with contextlib.redirect_stdout(io.StringIO()):\n    status = status_of(sys.argv[1:])\n"
        "print(json.dumps([status, sorted({m.split('.')[0] for m in sys.modules})]))"
    )
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=True)
    status, names = json.loads(done.stdout)
    assert status == 0, done.stderr
    return set(names)


HEAVY = {
    "PIL",
    "numpy",
    "scipy",
    "skfem",
    "rich",
    "matplotlib",
    "jinja2",
    "meshio",
    "pyvista",
    "numba",
    "msgspec",
    "tomllib",
}


@pytest.mark.parametrize(
    ("words", "allowed"),
    [
        (("--help",), set()),
        (("run", "--help"), set()),
        (("quantities",), {"msgspec"}),
        (("scenes",), {"msgspec", "tomllib"}),
        (("schema",), {"msgspec", "tomllib"}),
        (("keys", "beam"), {"msgspec", "tomllib", "rich"}),
        (("show", "paper"), {"msgspec", "tomllib"}),
        (("catalogue", "paper"), {"msgspec", "tomllib", "numpy"}),
        (("measure", "mode.frequency", "model=analytic", "mode=22"), {"msgspec", "tomllib"}),
        (("measure", "drive.rule_frequency"), {"msgspec", "tomllib"}),
        (("measure", "mode.frequency", "model=segment", "mode=3", "count=9"), {"msgspec", "tomllib", "numpy"}),
        (("measure", "mode.shape_error", "model=segment", "mode=3", "count=49"), {"msgspec", "tomllib", "numpy"}),
        (
            ("measure", "mode.frequency", "model=fem", "mode=3", "count=9"),
            {"msgspec", "tomllib", "numpy", "scipy", "skfem"},
        ),
        (("measure", "wave.standing_wave_ratio"), {"msgspec", "tomllib", "numpy"}),
        (
            ("measure", "motion.deflection", "--scene", "paper-slider", "model=segment", "count=49", "x=0.2137"),
            {"msgspec", "tomllib", "numpy", "scipy"},
        ),
        (
            ("measure", "slider.displacement", "--scene", "paper-slider", "model=segment", "count=49"),
            {"msgspec", "tomllib", "numpy", "scipy", "numba"},
        ),
        (
            ("measure", "friction.free_decay", "mu=0.2", "slope=100", "speed=0.1", "time=0.1"),
            {"msgspec", "tomllib", "numpy", "numba", "scipy"},  # numba looks for scipy itself
        ),
        (
            ("compare", str(LIST), "--scene", "steel-cantilever", "--count", "30"),
            {"msgspec", "tomllib", "numpy", "scipy", "skfem", "rich"},
        ),
        (("plan", "paper-slider", "--json"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
        (("plan", "paper", "--json"), {"msgspec", "tomllib", "numpy"}),
        (("table", "paper", "--counts", "30,40", "--csv"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
        (("run", "paper", "--no-report", "--json"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
    ],
    ids=lambda value: " ".join(Path(word).name for word in value) if isinstance(value, tuple) else "",
)
def test_a_command_loads_only_what_it_uses(words, allowed):
    assert loaded_by(*words) & HEAVY <= allowed


def test_an_export_loads_meshio_where_it_writes_a_mesh_alone(tmp_path):
    words = ("export", "paper", "--what", "modes", "--count", "9", "--modes", "3", "--to")
    plain = {"msgspec", "tomllib", "numpy"}
    assert loaded_by(*words, str(tmp_path / "m.csv")) & HEAVY <= plain
    assert "meshio" in loaded_by(*words, str(tmp_path / "m.vtu"))


def test_importing_the_package_loads_nothing_heavy():
    code = "import verify, sys, json; print(json.dumps(sorted({m.split('.')[0] for m in sys.modules})))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(json.loads(done.stdout)) & HEAVY
    assert verify.Beam.__module__ == "verify.beam"
    with pytest.raises(AttributeError, match="Baem"):
        _ = verify.Baem


def test_until_the_command_can_answer_an_interrupt_nothing_is_read_but_the_package_and_its_door():
    code = "import sys\nbefore = set(sys.modules)\nimport verify.__main__\nprint(*sorted(set(sys.modules) - before))"
    path = {"PYTHONPATH": str(Path(verify.__file__).parents[1])}
    done = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=True, env=path)
    assert done.stdout.split() == ["verify", "verify.__main__"]


def read_by(*words):
    """Modules that a command line really read in a fresh process, started as `verify` is; those asleep are not read."""
    code = (
        "import sys, json, io, contextlib\nfrom verify.asleep import put_to_sleep\nput_to_sleep()\n"
        "from verify.cli import status_of\n"
        "with contextlib.redirect_stdout(io.StringIO()):\n    status = status_of(sys.argv[1:])\n"
        "asleep = [n for n, m in list(sys.modules.items()) if type(m).__name__ in ('_LazyModule', 'Unread', 'Gathering')]\n"
        "print(json.dumps([status, sorted(set(sys.modules) - set(asleep)), asleep]))"
    )
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=True)
    status, names, asleep = json.loads(done.stdout)
    assert status == 0, done.stderr
    return set(names), set(asleep)


SLOW = {
    "importlib.metadata",
    "numpy.f2py",
    "numpy.ma",
    "numpy.random",
    "numpy.testing",
    "matplotlib",
    "rich",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.sparse",
    "scipy.sparse.csgraph",
    "scipy.spatial",
    "scipy.special",
    "skfem",
}


@pytest.mark.parametrize(
    ("words", "allowed"),
    [
        (("measure", "mode.frequency", "model=segment", "mode=22", "count=49"), set()),
        (
            ("measure", "mode.frequency", "model=fem", "mode=22", "count=49"),
            {"numpy.random"},  # of scikit-fem and scipy.sparse their modules; numpy.random by scipy
        ),
        (
            ("measure", "wave.standing_wave_ratio", "--scene", "paper-wave", "model=segment", "count=49"),
            {"numpy.random"},  # a start vector for the distance to a resonance; of scipy.linalg LAPACK's modules
        ),
        *(
            (
                ("measure", "wave.standing_wave_ratio", "--scene", "paper-wave", "model=segment", *words),
                {"numpy.random"},
            )
            for words in (("count=300",), ("count=49", "theory=timoshenko"))
        ),
    ],
    ids=["segment figure", "element figure", "wave figure", "wave on many", "wave on thick links"],
)
def test_a_figure_reads_only_the_parts_of_packages_that_it_uses(words, allowed):
    read, asleep = read_by(*words)
    assert read & SLOW <= allowed
    assert not asleep & read


def test_what_is_asleep_wakes_when_it_is_looked_into():
    code = (
        "import sys\nfrom verify.asleep import ASLEEP, put_to_sleep\nput_to_sleep()\nput_to_sleep()\n"
        "import numpy, scipy.linalg, scipy.sparse.linalg\n"
        "kinds = [type(m).__name__ for m in (numpy.ma, scipy.linalg, scipy.sparse.linalg)]\n"
        "assert kinds == ['_LazyModule', 'Gathering', 'Gathering'], kinds\n"
        "from scipy.linalg.lapack import dgtsv\n"
        "import skfem, skfem.refdom\n"
        "assert not hasattr(scipy.linalg, '_not_there')\n"
        "assert [type(m).__name__ for m in (scipy.linalg, skfem)] == ['Gathering'] * 2\n"
        "assert skfem.MeshLine([0.0, 0.4, 1.0]).nelements == 2\n"
        "assert skfem.refdom.RefLine is skfem.element.ElementLineHermite.refdom\n"
        "assert scipy.linalg.det([[3.0, 1.0], [1.0, 2.0]]) == 5.0\n"
        "assert numpy.ma.masked_less(numpy.arange(3), 1).sum() == 3\n"
        "from numpy.polynomial.legendre import leggauss\n"
        "assert type(numpy.polynomial).__name__ == 'Gathering' and 'numpy.polynomial.chebyshev' not in sys.modules\n"
        "assert numpy.polynomial.Chebyshev([0.0, 1.0])(0.3) == 0.3 and 'numpy.polynomial.chebyshev' in sys.modules\n"
        "import pickle, numpy.typing\n"
        "assert type(pickle).__name__ == type(numpy.typing).__name__ == 'Unread'\n"
        "assert pickle.loads(pickle.dumps(numpy.arange(3))).sum() == 3\n"
        "assert numpy.typing.NBitBase and numpy.typing.NDArray is not numpy.ndarray\n"
        "assert numpy.random.default_rng(3).random() < 1.0\n"
        "assert scipy.sparse.linalg.norm(scipy.sparse.eye_array(4)) == 2.0\n"
        "assert sys.meta_path.count(sys.meta_path[0]) == 1\n"
        "from importlib.util import find_spec\n"
        "assert all(find_spec(name) for name in set(ASLEEP) - {'typing_extensions'})\n"  # which others bring, or not
    )
    subprocess.run([sys.executable, "-W", "error::ImportWarning", "-c", code], check=True)


def test_a_name_that_is_had_from_its_home_is_the_one_that_its_package_gathers():
    """Also that a package is still read after its modules were had without it."""
    code = (
        "from importlib import import_module\n"
        "from verify.asleep import GATHERS, Gathering, LateMap, put_to_sleep\nput_to_sleep()\n"
        "packages = [(import_module(package), homes) for package, homes in GATHERS.items()]\n"
        "had = [{name: getattr(package, name) for name in homes} for package, homes in packages]\n"
        "assert all(type(package) is Gathering for package, homes in packages)\n"
        "for (package, homes), names in zip(packages, had, strict=True):\n"
        "    package.__all__ if type(package) is Gathering and hasattr(package, '__all__') else None\n"
        "    assert type(package) is not Gathering, package\n"
        "    for name, one in names.items():\n"
        "        there = getattr(package, name)\n"
        "        assert there is one or (isinstance(one, LateMap) and there == one and len(there) > 3), (package, name)\n"
        "assert sum(map(len, had)) > 30\n"
    )
    subprocess.run([sys.executable, "-W", "error::ImportWarning", "-c", code], check=True)


def test_what_is_spared_means_the_same_where_it_is_asked_for():
    import _pickle
    import typing

    import numpy as np

    from verify.asleep import SPARED

    assert np.typing.NDArray[np.float64].__origin__ is np.ndarray
    for name, home in SPARED["typing_extensions"].items():
        assert home == f"typing:{name}"
        assert hasattr(typing, name)
    for name, home in SPARED["pickle"].items():
        assert getattr(pickle, name) is getattr(_pickle, home.partition(":")[2])


@pytest.mark.parametrize("bits", [1, 7, 8, 128])
def test_a_seed_that_nobody_gives_is_drawn_as_the_standard_library_draws_it(monkeypatch, bits):
    monkeypatch.setattr(os, "urandom", lambda n: bytes(range(200, 200 + n)))
    monkeypatch.setattr(random, "_urandom", os.urandom)
    assert randbits(bits) == secrets.randbits(bits)


def test_importing_the_package_puts_nothing_to_sleep():
    code = "import verify, verify.cli, sys; print([f for f in sys.meta_path if 'Sleepers' in repr(f)])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
