"""What may import what, and what a command pays for."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import verify

PACKAGE = Path(verify.__file__).parent
MODELS = ("analytic_modes", "fem_beam", "segment_model")
# the house, from the ground up: a module imports only from floors below its own
FLOORS = [
    {"errors", "timing", "search", "words"},
    {"chain_work", "patience", "beam", "checked", "files", "contact_kernels", "chain_kernels", "elastic_kernels"},
    {"modes", "fields", "closed_forms", "eigen", "division", "chain_walls", "slider", "time_basis", "slider_figures"},
    {
        "error_laws",
        "extended_precision",
        "chain",
        "harmonic_solvers",
        "analytic_harmonic",
        "section_minors",
        "drives",
        "forcing",
        "contact",
        "claims",
    },
    {"point_loads", "motion", "validity"},
    {"chain_system", *MODELS},
    {
        "segment_motion",
        "fem_motion",
        "analytic_motion",
        "chain_statics",
        "chain_elastic",
        "chain_modes",
        "chain_linear",
    },
    {"moving_surface", "chain_dynamics"},
    {"slider_run", "energy", "chain_motion", "moving_mass", "excited", "request"},
    {"margins"},
    {"chain_modal", "chain_slider"},
    {"chain_studies"},
    {"compare", "intervals"},
    {"travelling_wave"},
    {"workbench"},
    {"quantity_types", "sizing"},
    {"wave_arguments"},
    {"waves", "unit_waves"},
    {"rigid_surface", "pure_wave", "carried", "operating_point"},
    {"simulate"},
    {"motion_arguments", "axial_study"},
    {"motions"},
    {"mode_quantities", "wave_quantities", "motion_quantities", "chain_quantities"},
    {"work_precision"},
    {"motion_study"},
    {"chain_readings"},
    {"readings"},
    {"quantities", "scene"},
    {"design_map"},
    {"gates", "claim_results", "claim_words"},
    {"studies", "wave_study"},
    {"plan"},
    {"run"},
    {"plain", "console"},
    {"tables", "report"},
    {"pytest_plugin", "cli"},
    {"__main__", "__init__"},
]


def imports_of(path, *, typing_too=False):
    """Names of our own modules that a file imports anywhere, but for typing alone."""
    tree = ast.parse(path.read_text("utf-8"))
    if not typing_too:
        for node in ast.walk(tree):
            if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
                node.body = []
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "verify":
            parts = node.module.split(".")
            found |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names if alias.name in known()}
        elif isinstance(node, ast.Import):
            found |= {a.name.split(".")[1] for a in node.names if a.name.startswith("verify.")}
    return found


def known():
    return set().union(*FLOORS)


def modules():
    return {p.parent.name if p.parent != PACKAGE else p.stem: p for p in sorted(PACKAGE.rglob("*.py"))}


@pytest.mark.parametrize("model", MODELS)
def test_a_model_imports_no_other_model_and_no_judge(model):
    own = {
        "analytic_modes": {"closed_forms", "analytic_harmonic", "section_minors"},
        "fem_beam": {"harmonic_solvers"},
        "segment_model": {"chain", "chain_walls", "point_loads", "harmonic_solvers"},
    }
    allowed = {"beam", "division", "modes", "fields", "errors", "eigen"} | own[model]
    assert imports_of(PACKAGE / f"{model}.py", typing_too=True) <= allowed


def test_what_a_model_is_made_of_knows_no_other_model_either():
    shared = {"beam", "division", "modes", "fields", "errors", "eigen"}
    parts = {
        "analytic_harmonic": {"closed_forms"},
        "section_minors": set(),
        "chain": {"chain_walls"},
        "point_loads": {"chain"},
        "harmonic_solvers": set(),
    }
    for part, own in parts.items():
        assert imports_of(PACKAGE / f"{part}.py", typing_too=True) <= shared | own, part


@pytest.mark.parametrize(
    ("motion", "own"),
    [
        ("segment_motion", {"segment_model", "chain", "chain_walls", "point_loads", "harmonic_solvers", "eigen"}),
        ("fem_motion", {"fem_beam", "division", "harmonic_solvers", "eigen"}),
        ("analytic_motion", {"analytic_modes", "closed_forms", "fields"}),
    ],
)
def test_a_models_motion_imports_no_other_model(motion, own):
    """Their agreement in time is evidence between independent modes, loads and readings."""
    assert imports_of(PACKAGE / f"{motion}.py", typing_too=True) <= {"beam", "errors", "time_basis"} | own


def test_numba_is_imported_in_the_kernels_alone_and_they_only_where_something_steps():
    kernels = {path.stem for path in PACKAGE.rglob("*.py") if "import njit" in path.read_text("utf-8")}
    assert "contact_kernels" in kernels
    assert all(name.endswith("_kernels") for name in kernels)
    for name in ("slider_run", "rigid_surface"):
        tree = ast.parse((PACKAGE / f"{name}.py").read_text("utf-8"))
        at_the_top = {alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names}
        assert not at_the_top & {"contact_kernels", "slide", "slide_on_belt"}


def test_closed_forms_know_no_model():
    assert imports_of(PACKAGE / "closed_forms.py", typing_too=True) == {"beam", "errors"}


def test_scikit_fem_is_imported_in_the_finite_element_model_alone():
    users = {path.stem for path in PACKAGE.rglob("*.py") if "skfem" in path.read_text("utf-8")}
    assert users == {"fem_beam"}


def test_imports_run_one_way_down_the_house():
    floor = {name: i for i, names in enumerate(FLOORS) for name in names}
    for path in PACKAGE.rglob("*.py"):
        name = "report" if path.parent.name == "report" else path.stem
        for imported in imports_of(path) - {name}:
            assert floor[imported] < floor[name], f"{name} imports {imported}, which is not below it"


def test_nothing_below_the_command_line_prints():
    for path in PACKAGE.rglob("*.py"):
        calls = {
            getattr(n.func, "id", "") for n in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(n, ast.Call)
        }
        assert "print" not in calls, path.name


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
    "numpy",
    "scipy",
    "skfem",
    "rich",
    "plotly",
    "jinja2",
    "meshio",
    "pyvista",
    "numba",
    "matplotlib",
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
        (("measure", "mode.frequency", "model=analytic", "mode=22"), {"msgspec", "tomllib"}),
        (("measure", "drive.rule_frequency"), {"msgspec", "tomllib"}),
        (("measure", "mode.frequency", "model=segment", "mode=3", "count=9"), {"msgspec", "tomllib", "numpy", "scipy"}),
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
        (("plan", "paper-slider", "--json"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
        (("plan", "paper", "--json"), {"msgspec", "tomllib", "numpy"}),
        (("table", "paper", "--counts", "30,40", "--csv"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
        (("run", "paper", "--no-report", "--json"), {"msgspec", "tomllib", "numpy", "scipy", "skfem"}),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_a_command_loads_only_what_it_uses(words, allowed):
    assert loaded_by(*words) & HEAVY <= allowed


def test_importing_the_package_loads_nothing_heavy():
    code = "import verify, sys, json; print(json.dumps(sorted({m.split('.')[0] for m in sys.modules})))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(json.loads(done.stdout)) & HEAVY
    assert verify.Beam.__module__ == "verify.beam"
    with pytest.raises(AttributeError, match="Baem"):
        _ = verify.Baem
