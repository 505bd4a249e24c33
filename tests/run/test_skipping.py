"""What must not happen: for each kind of scene, what is loaded, solved, stepped, drawn and written, counted."""

import pytest
from counted import counted

LIBRARIES = {"numpy", "scipy", "skfem", "numba", "rich", "jinja2", "matplotlib", "msgspec", "click"}
BEAM = """
name = "strip"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
"""
DRIVEN = """
drive = { frequency_hz = 310.0, force = [{ position = 0.1 }, { position = 0.1, measured_from = "right", phase_deg = 90.0 }] }
"""
SLIDES = """
slider = { mass = 1e-4, mu = 0.2, coupling = "COUPLING" }
"""


def gate(name, quantity, arguments):
    return f'[[gate]]\nid = "{name}"\nquantity = "{quantity}"\narguments = {arguments}\nat_least = -1e9\nwhy = "It is asked."\n'


def figures(model, *modes, count=17):
    return "".join(
        gate(f"{model}-{mode}", "mode.frequency", f'{{ model = "{model}", mode = {mode}, count = {count} }}')
        for mode in modes
    )


KINDS = {
    "closed forms": (
        BEAM
        + gate("second", "mode.frequency", '{ model = "analytic", mode = 2 }')
        + gate("rule", "drive.rule_frequency", "{ mode = 3 }"),
        {},
        {"msgspec", "click"},
        {"elements", "segments", "waves", "chain"},
    ),
    "modes of segments": (
        BEAM + figures("segment", 2, 5, 3),
        {"eigen-solves": 1, "solves": 1},
        {"msgspec", "click", "numpy", "scipy"},
        {"elements", "waves", "chain"},
    ),
    "modes of both": (
        BEAM + figures("segment", 2, 5) + figures("fem", 1, 4) + figures("segment", 1, count=23),
        {"eigen-solves": 3, "solves": 3},
        {"msgspec", "click", "numpy", "scipy", "skfem"},
        {"waves", "chain"},
    ),
    "a stepped beam's exact roots": (
        BEAM.replace("710.0", "710.0, section = [{ length = 0.2 }, { length = 0.41, thickness = 0.003 }]")
        + figures("fem", 3)
        + gate("error", "mode.frequency_error", '{ model = "fem", mode = 3, count = 17 }')
        + gate("of-29", "mode.frequency_error", '{ model = "fem", mode = 3, count = 29 }'),
        {"eigen-solves": 2, "solves": 2, "exact roots": 1},
        {"msgspec", "click", "numpy", "scipy", "skfem"},
        {"segments", "waves", "chain"},
    ),
    "a wave": (
        BEAM
        + DRIVEN
        + gate("ratio", "wave.standing_wave_ratio", '{ model = "segment", count = 31 }')
        + gate("same-field", "wave.reflection", '{ model = "segment", count = 31 }')
        + gate("exact", "wave.crest_speed", "{}"),
        {"fields": 2},
        {"msgspec", "click", "numpy", "scipy"},
        {"elements", "chain"},
    ),
    "a slider that the beam does not feel": (
        BEAM
        + DRIVEN
        + SLIDES.replace("COUPLING", "one-way")
        + gate("goes", "slider.displacement", '{ model = "segment", count = 9, time = 0.02 }')
        + gate("same-run", "slider.deflection", '{ model = "segment", count = 9, time = 0.02, x = 0.2 }'),
        {"simulations": 2, "time bases": 2},
        {"msgspec", "click", "numpy", "scipy", "numba"},
        {"elements", "chain", "waves"},
    ),
    "a slider that the beam feels": (
        BEAM
        + DRIVEN
        + SLIDES.replace("COUPLING", "two-way")
        + gate("goes", "slider.displacement", '{ model = "fem", count = 9, time = 0.02 }')
        + gate("same-run", "slider.mean_speed", '{ model = "fem", count = 9, time = 0.02 }'),
        {"simulations": 1, "time bases": 1},
        {"msgspec", "click", "numpy", "scipy", "numba", "skfem"},
        {"chain", "waves"},
    ),
    "a beam in time": (
        BEAM + DRIVEN + gate("goes", "motion.deflection", '{ model = "segment", count = 9, time = 0.02, x = 0.2 }'),
        {"simulations": 1, "time bases": 1},
        {"msgspec", "click", "numpy", "scipy"},
        {"elements", "chain", "waves"},
    ),
    "a wave's study": (
        BEAM + DRIVEN + "wave = {}\n",
        {"fields": 86},
        {"msgspec", "click", "numpy", "scipy", "skfem"},
        {"chain"},
    ),
    "a row of the stress table": (
        BEAM + 'stress = { rows = ["closed-form-frequencies"] }\n',
        {},
        {"msgspec", "click", "numpy"},
        {"identify", "exports", "pictures"},
    ),
    "a nonlinear chain": (
        BEAM + gate("tip", "chain.cantilever_tip", "{ segments = 9, load = 3.0 }"),
        {"chain equilibria": 1},
        {"msgspec", "click", "numpy", "scipy", "numba"},
        {"elements", "exact", "waves"},
    ),
}
"""(the scene, all the work that is done, libraries that are loaded, rooms that are not entered)."""
FREE = {"contact", "factorisations", "compilations"}
"""Work whose number is the method's own affair: of a search along the beam, of a field, of what is not compiled yet."""
STEPPED = {"a slider that the beam does not feel", "a slider that the beam feels"}
FACTORED = {"modes of both", "a stepped beam's exact roots", "a wave", "modes of segments"}
COMPILED = {*STEPPED, "a nonlinear chain"}


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_loads_solves_and_steps_what_it_asks_for_once_and_nothing_else(tmp_path, kind):
    text, work, libraries, not_entered = KINDS[kind]
    (tmp_path / "strip.toml").write_text(text)
    found = counted(tmp_path, "run", "strip.toml", "--no-report", "--json")
    assert found.status == 0, found.out
    assert {name: n for name, n in found.work.items() if name not in FREE} == work
    assert found.libraries & LIBRARIES <= libraries
    assert not found.rooms & not_entered
    for name, kinds in (("contact", STEPPED), ("factorisations", FACTORED), ("compilations", COMPILED)):
        assert kind in kinds or not found.times(name), name
    assert found.times("contact") or kind not in STEPPED
    assert [path.name for path in tmp_path.iterdir()] == ["strip.toml"]


FOOT = """
slider = { mass = 0.01, mu = 0.2, law = "coulomb", preload = 2.0, coupling = "one-way", contact = { stiffness = 6e4 } }
"""


def test_gates_of_one_motor_hold_its_slider_once_and_run_it_nowhere_else(tmp_path):
    """On one model at one speed: no free run, no other model, no chain, no figure."""
    asked = '{ model = "segment", count = 17 }'
    gates = gate("holds", "slider.normal_mean", asked) + gate("again", "slider.contact_share", asked)
    (tmp_path / "strip.toml").write_text(BEAM + DRIVEN + FOOT + gates)
    found = counted(tmp_path, "run", "strip.toml", "--no-report", "--json")
    assert found.times("held sliders") == 1
    assert not set(found.work) & {
        "free runs of motors",
        "simulations",
        "chain motions",
        "charts",
        "pages",
        "files",
        "solves",
    }
    assert found.libraries & LIBRARIES <= {"msgspec", "click", "numpy", "scipy", "numba"}
    assert not found.rooms & {"elements", "chain", "waves", "pictures", "exports"}


def test_a_bench_of_modes_moves_nothing_drives_nothing_and_compiles_nothing(tmp_path):
    bench = 'bench = { sets = ["modes"], modes = [1], counts = [9, 17], seconds = 0.3, imports = false }\n'
    (tmp_path / "strip.toml").write_text(BEAM + bench)
    found = counted(tmp_path, "run", "strip.toml", "--no-report", "--json")
    assert found.status == 0
    assert set(found.work) <= {"solves", "eigen-solves", "factorisations", "timed"}
    assert found.libraries & LIBRARIES <= {"msgspec", "click", "numpy", "scipy", "skfem"}
    assert not found.rooms & {"chain", "waves", "pictures", "exports"}
    assert len(found.told["bench"]["rows"]) >= 8


@pytest.mark.parametrize("kind", KINDS)
def test_a_plan_does_none_of_what_it_plans(tmp_path, kind):
    """Three fields of the exact beam, closed forms, say how large it is what a beam may feel of its slider."""
    (tmp_path / "strip.toml").write_text(KINDS[kind][0])
    found = counted(tmp_path, "plan", "strip.toml", "--json")
    assert found.status == 0
    assert found.work == ({"fields": 3} if kind in STEPPED else {})
    assert not found.rooms & {"elements", "segments"} or kind not in STEPPED
    assert not found.libraries & {"numba", "rich", "jinja2", "matplotlib"}
    assert len(found.told["solves"]) == KINDS[kind][1].get("solves", 0)


@pytest.mark.parametrize(
    ("words", "work", "libraries"),
    [
        (("--help",), {}, {"click"}),
        (("run", "--help"), {}, {"click"}),
        (("scenes", "--json"), {}, {"click", "msgspec"}),
        (("show", "strip.toml"), {}, {"click", "msgspec"}),
        (("choose", "--mode", "3", "--error", "1%", "--scene", "strip.toml", "--json"), {"eigen-solves"}, {"click", "msgspec", "numpy", "scipy", "skfem"}),
        (("compare", "list.csv", "--scene", "strip.toml", "--kind", "segments", "--count", "9", "--json"), {"eigen-solves", "exact roots"}, {"click", "msgspec", "numpy", "scipy", "skfem"}),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)  # fmt: skip
def test_other_commands_do_what_they_say_and_nothing_else(tmp_path, words, work, libraries):
    (tmp_path / "strip.toml").write_text(BEAM)
    (tmp_path / "list.csv").write_text("12.4\n49.9\n112.1\n")
    found = counted(tmp_path, *words)
    assert found.status in (0, 1)
    assert set(found.work) - {"factorisations", "timed", "solves"} <= set(work)
    assert found.libraries & LIBRARIES <= libraries
    assert len(list(tmp_path.iterdir())) == 2


def test_a_report_is_drawn_and_written_once_where_it_is_wanted_and_nowhere_else(tmp_path):
    text = BEAM + "spectrum = { modes = 3, count = 9 }\n" + figures("segment", 2)
    (tmp_path / "strip.toml").write_text(text)
    wanted, not_wanted = (counted(tmp_path, "run", "strip.toml", "--json", *more) for more in ((), ("--no-report",)))
    drawn = {"charts", "pages", "files"}
    assert {name: wanted.times(name) for name in drawn} == {"charts": 1, "pages": 1, "files": 3}
    assert not drawn & set(not_wanted.work)
    assert not not_wanted.libraries & {"jinja2", "matplotlib"}
    assert "matplotlib" in wanted.libraries
    assert wanted.times("solves") == not_wanted.times("solves") == 3


def test_several_scenes_draw_their_pages_and_one_picture_each_and_without_a_report_nothing(tmp_path):
    for name in ("strip", "other"):
        text = BEAM.replace("strip", name) + "spectrum = { modes = 3, count = 9 }\n" + figures("segment", 2)
        (tmp_path / f"{name}.toml").write_text(text)
    both = ("run", "strip.toml", "other.toml", "--json")
    wanted, not_wanted = (counted(tmp_path, *both, *more) for more in ((), ("--no-report",)))
    assert not {"charts", "pages", "files"} & set(not_wanted.work)
    assert not not_wanted.libraries & {"jinja2", "matplotlib", "rich", "numba"}
    assert not {"verify.report.drawing", "verify.report.html"} & not_wanted.modules
    assert {name: wanted.times(name) for name in ("pages", "files")} == {"pages": 2, "files": 6}
    assert wanted.times("solves") == not_wanted.times("solves") == 6


def test_beside_what_is_timed_a_study_solves_each_size_once(tmp_path):
    text = BEAM + "convergence = { modes = [1, 4], counts = [7, 11] }\nspectrum = { modes = 5, count = 11 }\n"
    (tmp_path / "strip.toml").write_text(text + figures("segment", 3, count=7))
    found = counted(tmp_path, "run", "strip.toml", "--no-report", "--json")
    assert found.status == 0
    assert found.times("solves") == len(found.told["solves"]) == 4
    assert found.times("eigen-solves") == 4 + found.times("timed")


def test_a_plan_of_a_slider_on_a_chain_loads_no_compiler(tmp_path):
    text = BEAM + DRIVEN + SLIDES.replace("COUPLING", "one-way")
    gates = gate("rides", "chain.slider_displacement", "{ segments = 9, time = 1e-3, soft_start_periods = 0 }")
    (tmp_path / "strip.toml").write_text(text + gates)
    found = counted(tmp_path, "plan", "strip.toml", "--json")
    assert found.status == 0
    assert "numba" not in found.libraries
    assert not found.times("chain motions")


def test_the_papers_wave_is_judged_without_an_optimiser_and_its_meshes_are_made_once(tmp_path):
    found = counted(tmp_path, "run", "paper-wave", "--no-report", "--json")
    assert found.status == 0
    assert not {name for name in found.modules if name.startswith(("scipy.optimize", "scipy.interpolate"))}
    assert found.libraries & LIBRARIES == {"msgspec", "click", "numpy", "scipy", "skfem"}
    made = [times for file, name, times in found.calls if file.endswith("elements/element.py") and name == "line_basis"]
    assert made == [5]
