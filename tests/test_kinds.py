"""A model, a quantity and a study from outside the package are worth as much as those inside it.

Each is a dozen lines below; nothing else in the suite knows of them, and CONTRIBUTING.md shows the same lines.
"""

import json
import re
import sys
from importlib.metadata import EntryPoint
from pathlib import Path

import msgspec
import numpy as np
import pytest

from verify import load_scene, run_scene
from verify.cli import status_of
from verify.errors import InputError
from verify.models.catalogue import MODELS, bounding
from verify.models.kind import Model
from verify.models.modes import Modes
from verify.quantities.catalogue import QUANTITIES
from verify.quantities.kind import Arguments, Quantity
from verify.registry import Registry, may_be_declared, unusable
from verify.report.html import page
from verify.run.plan import plan_scene
from verify.studies.catalogue import STUDIES
from verify.studies.chart import Axis, Bars, Chart
from verify.studies.kind import Study
from verify.studies.told import Column, Found, Table

SCENE = """
name = "toy"

[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470.0

[spectrum]
modes = 3
count = 11

[heaviness]
over = 2.0

[[gate]]
id = "toy-mode-2"
quantity = "mode.frequency_error"
arguments = { model = "sine", mode = 2, count = 11 }
expect = 0.02
within = 1e-9
why = "2 % high by construction"

[[gate]]
id = "weight"
quantity = "toy.weight"
arguments = { gravity = 9.0 }
expect = 2.09393127
within = 1e-6
why = "4470 * 0.031 * 0.0023 * 0.73 kg times 9"
"""


# the lines of CONTRIBUTING.md: model
class Sine(Model):
    """Modes of a pinned beam, each two per cent too high."""

    name, parts, title = "sine", "sines", "Sines"

    def refuses(self, beam):
        return "" if beam.supports == ("pinned", "pinned") else "its sines fit pinned ends alone"

    def solve_modes(self, beam, n_modes, count, **settings):
        n = np.arange(1, n_modes + 1)
        x = np.linspace(0.0, beam.length, count + 1)
        mass = sum(piece.mass_per_length * piece.length for piece in beam.pieces)

        def shapes(at, derivative):
            k = np.pi * n[:, None] / beam.length
            return np.sqrt(2.0 / mass) * k**derivative * np.sin(k * at + derivative * np.pi / 2.0)

        hertz = 1.02 * n**2 * np.pi / 2.0 * beam.wave_constant / beam.length**2
        return Modes.of_shapes(self.name, count, hertz, x, shapes)


# quantity
class Weight(Arguments, frozen=True, kw_only=True):
    """Where it is weighed."""

    gravity: float = 9.81


def weight(a, scene, bench):
    return a.gravity * sum(piece.mass_per_length * piece.length for piece in scene.beam.pieces)


WEIGHT = Quantity("toy.weight", "N", "What the beam weighs.", Weight, "closed form", weight)


# study
class Heaviness(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how heavy the beam is."""

    over: float = 1.0


class HeavinessFound(Found, frozen=True, eq=False, kw_only=True):
    """How heavy it is."""

    newton: float

    def facts(self):
        return (f"the beam weighs {self.newton:.3f} N",)

    def tables(self):
        return (Table(columns=(Column("beam", left=True), Column("N", ".3f")), rows=(("this one", self.newton),)),)

    def charts(self):
        bar = Bars(names=("beam",), values=(self.newton,), colours=("#2f80ed",))
        return (Chart(id="heaviness", title="Weight", caption="Of the beam.", x=Axis("N"), y=Axis(""), bars=bar),)


class HeavinessStudy(Study[Heaviness, HeavinessFound]):
    """Weighs the beam."""

    name, section, title = "heaviness", Heaviness, "How heavy"

    def run(self, asked, scene, bench, done, step):
        step("weighing")
        return HeavinessFound(newton=asked.over * weight(Weight(), scene, bench))


@pytest.fixture
def toys():
    with MODELS.registered(Sine()), QUANTITIES.registered(WEIGHT), STUDIES.registered(HeavinessStudy()):
        yield


@pytest.fixture
def scene(tmp_path, toys):
    path = tmp_path / "toy.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def test_the_plan_knows_them(scene):
    plan = plan_scene(load_scene(scene))
    assert any(solve.model == "sine" and solve.count == 11 for solve in plan.solves)
    assert {"gate weight", "heaviness"} <= set(plan.closed_forms)
    assert plan.problems == ()


def test_a_run_judges_and_studies_them(scene):
    result = run_scene(scene)
    assert [gate.passed for gate in result.gates] == [True, True]
    assert result.found["heaviness"].newton == pytest.approx(2.0 * 9.81 * 4470 * 0.031 * 0.0023 * 0.73)
    assert result.found["spectrum"].errors["sine"] == pytest.approx((0.02, 0.02, 0.02))


def test_json_terminal_and_page_tell_of_them(scene, capsys):
    assert status_of(["run", str(scene), "--no-report", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["heaviness"]["newton"] == pytest.approx(4.5647, rel=1e-4)
    assert told["spectrum"]["sine"][1] == pytest.approx(0.02)
    assert status_of(["run", str(scene), "--no-report"]) == 0
    assert "the beam weighs 4.565 N" in capsys.readouterr().out
    shown = page(run_scene(scene), "verify run toy.toml")
    assert 'id="heaviness"' in shown
    assert "How heavy" in shown
    assert Sine.title in shown


def test_tables_have_a_column_for_them(scene, capsys):
    assert status_of(["table", str(scene), "--of", "heaviness", "--csv"]) == 0
    assert capsys.readouterr().out.startswith("beam,N\nthis one,4.56")
    assert status_of(["table", str(scene), "--counts", "7,9", "--modes", "2", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["sine_error"] for row in rows] == pytest.approx([0.02, 0.02])
    assert status_of(["table", str(scene), "--counts", "7,9", "--modes", "2"]) == 0
    assert "Sines" in capsys.readouterr().out


def test_they_are_measured_chosen_and_listed_by_name(toys, capsys):
    assert status_of(["measure", "mode.frequency_error", "model=sine", "mode=3", "count=9", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["value"] == pytest.approx(0.02)
    assert status_of(["choose", "--mode", "2", "--error", "3%", "--json"]) == 0
    chosen = {one["model"]: one["count"] for one in json.loads(capsys.readouterr().out)["choices"]}
    assert set(chosen) == {"segment", "fem", "sine"}
    assert status_of(["quantities"]) == 0
    assert "toy.weight" in (listed := capsys.readouterr().out)
    assert "fem | segment | sine" in listed


def test_a_verb_that_a_model_lacks_is_refused_by_name(toys, capsys):
    assert status_of(["measure", "wave.crest_speed", "model=sine", "count=9", "--scene", "paper-wave"]) == 2
    assert "model = 'sine' is not known" in capsys.readouterr().err
    with pytest.raises(InputError, match=r"sine.*no harmonic fields"):
        MODELS["sine"].solve_harmonic(load_scene("paper").beam, (), 433.0, 9)


def test_pytest_collects_their_gates(pytester):
    """In a process of its own, where a conftest registers them."""
    pytester.makefile(".toml", toy=SCENE)
    pytester.makeconftest(
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r})\n"
        "from test_kinds import WEIGHT, HeavinessStudy, Sine\n"
        "from verify.models.catalogue import MODELS\nfrom verify.quantities.catalogue import QUANTITIES\n"
        "from verify.studies.catalogue import STUDIES\n"
        "MODELS.register(Sine()); QUANTITIES.register(WEIGHT); STUDIES.register(HeavinessStudy())\n"
    )
    done = pytester.runpytest_subprocess("toy.toml", "-q")
    done.assert_outcomes(passed=2)


@pytest.mark.parametrize("given", [None, "heavy", [2.0]])
def test_a_quantity_that_gives_no_figure_is_a_failed_gate(scene, given):
    with QUANTITIES.registered(msgspec.structs.replace(WEIGHT, evaluate=lambda a, scene, bench: given)):
        (found,) = [gate for gate in run_scene(scene).gates if gate.id == "weight"]
    assert not found.passed
    assert "which is no figure" in found.reason


def test_they_are_gone_when_nobody_holds_them_any_more(tmp_path):
    path = tmp_path / "toy.toml"
    path.write_text(SCENE, encoding="utf-8")
    with pytest.raises(InputError, match="heaviness is not a known key"):
        load_scene(path)
    assert "sine" not in MODELS
    assert "toy.weight" not in QUANTITIES


def test_entry_points_of_other_packages_are_taken_up(tmp_path, pytester, monkeypatch):
    """A package that declares one of each is installed beside this one: nobody imports it, a name does."""
    info = tmp_path / "toys-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: toys\nVersion: 1.0\n", encoding="utf-8")
    (info / "entry_points.txt").write_text(
        "[verify.models]\nsine = test_kinds:Sine\n[verify.quantities]\ntoy.weight = test_kinds:WEIGHT\n"
        "[verify.studies]\nheaviness = test_kinds:HeavinessStudy\n",
        encoding="utf-8",
    )
    path = tmp_path / "toy.toml"
    path.write_text(SCENE, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{Path(__file__).parent}:{Path(__file__).parent.parent}")
    done = pytester.run(sys.executable, "-m", "verify", "run", str(path), "--no-report")
    done.stdout.fnmatch_lines(["*all 2 gates passed*"])


BROKEN = """[verify.models]
gone = no_such_module:Sine
other = test_kinds:Sine
[verify.quantities]
toy.raises = explodes:WEIGHT
[verify.studies]
lost = test_kinds:Nowhere
heaviness = test_kinds:HeavinessStudy
"""


@pytest.fixture
def broken(tmp_path, pytester, monkeypatch):
    """Run a command line beside a package of which hardly an entry point can be used."""
    info = tmp_path / "toys-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: toys\nVersion: 1.0\n", encoding="utf-8")
    (info / "entry_points.txt").write_text(BROKEN, encoding="utf-8")
    (tmp_path / "explodes.py").write_text("raise RuntimeError('one\\ntwo')\n", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{Path(__file__).parent}:{Path(__file__).parent.parent}")
    monkeypatch.chdir(tmp_path)

    def call(*words):
        done = pytester.run(sys.executable, "-m", "verify", *words)
        return done.ret, done.outlines, done.errlines

    return call


def test_a_package_that_cannot_be_imported_breaks_no_command_that_does_not_ask_for_it(broken):
    status, out, err = broken("measure", "mode.frequency", "model=segment", "mode=2", "count=9")
    assert (status, err) == (0, [])
    assert out[0].startswith("mode.frequency = ")
    assert broken("plan", "free-free-bar", "--set", "spectrum={}")[0] == 0


def test_what_of_a_package_cannot_be_used_is_one_sentence_where_all_are_listed(broken):
    status, out, err = broken("quantities")
    assert status == 0
    assert any(line.startswith("mode.frequency ") for line in out)
    assert err == [
        "verify: left out: quantity = 'toy.raises' of toys, explodes:WEIGHT, cannot be used (RuntimeError: one\\ntwo): "
        "mend that package or uninstall it",
        "verify: left out: model = 'gone' of toys, no_such_module:Sine, cannot be used (ModuleNotFoundError: No module "
        "named 'no_such_module'): mend that package or uninstall it",
        "verify: left out: model = 'other' of toys, test_kinds:Sine, cannot be used (it is no model of that name): "
        "mend that package or uninstall it",
    ]


def test_a_gate_on_what_cannot_be_used_fails_and_what_was_left_out_is_told(broken, tmp_path):
    (tmp_path / "toy.toml").write_text(SCENE.replace('model = "sine"', 'model = "gone"'), encoding="utf-8")
    status, out, err = broken("run", "toy.toml", "--no-report")
    assert status == 1
    assert "gate toy-mode-2: cannot be evaluated: model = 'gone' of toys" in " ".join(out)
    assert {line.split(" of toys")[0].removeprefix("verify: left out: ") for line in err} == {
        "model = 'gone'",
        "model = 'other'",
        "quantity = 'toy.raises'",
        "study = 'lost'",
    }


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("measure", "mode.frequency", "model=gone", "mode=2", "count=9"), "model = 'gone' of toys"),
        (("measure", "toy.raises"), "quantity = 'toy.raises' of toys"),
        (("table", "paper", "--of", "lost"), "study = 'lost' of toys"),
        (("plan", "lost.toml"), "study = 'lost' of toys"),
    ],
)
def test_asked_for_by_name_it_is_refused_with_the_reason(broken, tmp_path, words, said):
    (tmp_path / "lost.toml").write_text(SCENE.replace("[heaviness]", "[lost]"), encoding="utf-8")
    status, out, err = broken(*words)
    assert (status, out, len(err)) == (2, [], 1)
    assert err[0].startswith(f"verify: {said}")
    assert "cannot be used (" in err[0]


def test_a_good_study_beside_a_broken_one_is_run(broken, tmp_path):
    text = SCENE.replace('model = "sine"', 'model = "segment"').replace('"toy.weight"', '"mode.frequency"')
    (tmp_path / "good.toml").write_text(text, encoding="utf-8")
    status, out, _ = broken("table", "good.toml", "--of", "heaviness", "--csv")
    assert (status, out[1].split(",")[0]) == (0, "this one")
    assert float(out[1].split(",")[1]) == pytest.approx(2.0 * 9.81 * 4470 * 0.031 * 0.0023 * 0.73)


@pytest.mark.parametrize(
    ("ask", "looks"),
    [
        (lambda models: models["near"], False),
        (lambda models: models.named("near"), False),
        (lambda models: "near" in models, False),
        (lambda models: models.own() == ("near",), False),
        (lambda models: models["far"].name == "far", True),
        (lambda models: "far" in models, True),
        (lambda models: "further" not in models, True),
        (lambda models: list(models) == ["near", "far"], True),
        (lambda models: len(models) == 2, True),
    ],
)
def test_other_packages_are_looked_at_for_a_name_that_is_not_known_and_no_other(monkeypatch, ask, looks):
    looked = []

    def entry_points(*, group):
        looked.append(group)
        return [EntryPoint("far", "test_kinds:Far", group), EntryPoint("near", "no_such_module:Far", group)]

    monkeypatch.setattr("importlib.metadata.entry_points", entry_points)
    monkeypatch.setattr("verify.registry.may_be_declared", lambda group, path: True)
    models = Registry("model", "toys.models", homes={"near": "test_kinds:Near"})
    assert ask(models)
    assert looked == (["toys.models"] if looks else [])
    assert unusable() == ()  # a name of our own stays ours


def test_what_other_packages_declare_is_seen_without_reading_what_they_are(tmp_path):
    """As `importlib.metadata` sees it, in a hundredth of its import; where it cannot be told, there may be something."""
    for folder, text in (("a-1.dist-info", "[toys.models]\nfar = far:Far\n"), ("b-2.egg-info", "[ toys.studies ]\n")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "entry_points.txt").write_text(text, encoding="utf-8")
    (tmp_path / "c-3.dist-info").mkdir()
    path = (str(tmp_path), str(tmp_path / "gone"))
    asked = ("toys.models", "toys.studies", "toys", "models", "verify.models")
    assert [may_be_declared(group, path) for group in asked] == [True, True, False, False, False]
    (tmp_path / "archive.zip").write_bytes(b"PK")
    assert may_be_declared("verify.models", (str(tmp_path / "archive.zip"),))
    (tmp_path / "d-4.dist-info").mkdir()
    (tmp_path / "d-4.dist-info" / "entry_points.txt").write_bytes(b"\xff\xfe")
    assert may_be_declared("verify.studies", (str(tmp_path),))
    assert may_be_declared("console_scripts", tuple(sys.path))
    assert may_be_declared("pytest11", tuple(sys.path))


class Near:
    """Something with a name."""

    name = "near"


class Far:
    """Something of another package."""

    name = "far"


def test_what_stood_in_a_place_stands_there_again():
    models = Registry("model", "toys.models", own=[near := Near()])
    other = Near()
    with models.registered(other, Far()):
        assert models["near"] is other
        assert "far" in models
    assert models["near"] is near
    assert "far" not in models


def test_the_guide_for_contributors_shows_these_lines():
    """Every line of the guide's examples stands in this file, but for what shortens it."""
    guide = (Path(__file__).parent.parent / "CONTRIBUTING.md").read_text("utf-8")
    own = {re.sub(r"\s+", " ", line).strip() for line in Path(__file__).read_text("utf-8").splitlines()}
    shown = [line.strip() for block in re.findall(r"```python\n(.*?)```", guide, re.S) for line in block.splitlines()]
    assert len(shown) > 20
    assert [line for line in shown if line and line not in own] == []


def test_a_guest_that_cannot_answer_takes_no_answer_of_ours_away(toys, capsys):
    """It is left out with its reason: of a size it never reaches, and of a beam it does not take."""
    assert status_of(["choose", "--mode", "5", "--error", "1%", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [one["model"] for one in told["choices"]] == ["segment", "fem"]
    assert "does not reach it" in told["left_out"]["sine"]
    assert status_of(["choose", "--mode", "5", "--error", "1%"]) == 0
    assert "sine is left out" in " ".join(capsys.readouterr().out.split())
    assert status_of(["choose", "steel-cantilever", "--mode", "1", "--error", "90%", "--json"]) == 0
    assert "its sines fit pinned ends alone" in json.loads(capsys.readouterr().out)["left_out"]["sine"]
    assert status_of(["table", "steel-cantilever", "--counts", "20,30", "--modes", "2", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert "sine_error" not in rows[0]
    assert rows[0]["fem_error"] > 0
    assert any("its sines fit pinned ends alone" in note for note in rows[0]["notes"])


def test_a_guest_changes_no_figure_of_ours(toys):
    """The two models that bound a frequency are ours, whatever others say of themselves."""
    bounded = type("Upper", (Sine,), {"name": "upper", "bounds": "above"})
    with pytest.raises(InputError, match="bounds nothing here"):
        MODELS.register(bounded())
    assert [model.name for model in bounding()] == ["segment", "fem"]
    assert list(MODELS)[-1] == "sine"
    assert [model.name for model in bounding()] == ["segment", "fem"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "beam"}, "a name that scenes or their results have already"),
        ({"name": "gates"}, "a name that scenes or their results have already"),
        ({"section": None}, "has no section"),
        ({"name": ""}, "has no name"),
    ],
)
def test_a_study_that_has_no_place_of_its_own_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        STUDIES.register(type("Odd", (HeavinessStudy,), change)())


def test_a_study_that_breaks_is_named(scene):
    def run(self, asked, scene, bench, done, step):
        raise ZeroDivisionError("no weight")

    broken, message = (
        type("Broken", (HeavinessStudy,), {"run": run})(),
        r"'heaviness' breaks: ZeroDivisionError: no weight",
    )
    with STUDIES.registered(broken), pytest.raises(InputError, match=message):
        run_scene(scene)


def test_a_table_as_data_is_in_the_units_above_it_and_loses_no_column():
    class Twice(Found, frozen=True, eq=False, kw_only=True):
        """Two columns of one head, one of which is scaled."""

        def tables(self):
            heads = (Column("model", left=True), Column("rms, µm", ".3g", 1e6), Column("rms, µm", ".3g"))
            return (Table(columns=(*heads, Column("error %", "bare percent")), rows=(("a", 2.5e-6, 7.0, -0.03),)),)

    assert Twice().records() == [{"model": "a", "rms, µm": 2.5, "rms, µm 2": 7.0, "error %": -3.0}]


def test_a_row_that_does_not_fit_its_table_is_said():
    with pytest.raises(InputError, match="a row of 2 cells under 1 columns"):
        Table(columns=(Column("one"),), rows=((1, 2),))


class NumpysFound(HeavinessFound, frozen=True, eq=False, kw_only=True):
    """The same in numbers of numpy's."""

    def tables(self):
        row = (np.int64(3), np.float64(self.newton))
        return (Table(columns=(Column("n"), Column("N", ".3f")), rows=(row,)),)


class NumpysStudy(HeavinessStudy):
    """Weighs it so."""

    def run(self, asked, scene, bench, done, step):
        step("weighing")
        return NumpysFound(newton=np.float64(asked.over * weight(Weight(), scene, bench)))


def test_numbers_of_numpys_are_numbers(tmp_path, monkeypatch, capsys):
    """What a quantity or a study from elsewhere gives is told as any other figure, on the page and as data."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "toy.toml").write_text(SCENE)
    kilo = msgspec.structs.replace(WEIGHT, evaluate=lambda *given: np.float64(weight(*given)))
    three = msgspec.structs.replace(WEIGHT, name="toy.three", evaluate=lambda *given: np.int64(3))
    registered = QUANTITIES.registered(kilo), QUANTITIES.registered(three), STUDIES.registered(NumpysStudy())
    with MODELS.registered(Sine()), registered[0], registered[1], registered[2]:
        assert status_of(["run", "toy.toml"]) == 0
        capsys.readouterr()
        assert status_of(["run", "toy.toml", "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["heaviness"]["newton"] == pytest.approx(2.0 * 9.81 * 2.09393127 / 9)
        assert status_of(["export", "toy.toml", "--what", "tables", "--to", "x.json"]) == 0
        capsys.readouterr()
        assert status_of(["measure", "toy.toml", "toy.three"]) == 0
        assert "3 N" in capsys.readouterr().out
