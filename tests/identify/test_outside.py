"""A model of somebody else's in Python, judged, and what is said of one that breaks."""

import json

import pytest

from verify.cli import status_of

MODEL = """
import numpy as np
from verify.models.kind import Model
from verify.segments.linear import solve_modes

class Mine(Model):
    name = "mine"
    fewest = 2
    unknowns_per_part = 1
    def solve_modes(self, beam, n_modes, count, **settings):
        return solve_modes(beam, n_modes, count, wall="half")

class Bare:
    def solve_modes(self, beam, n_modes, count):
        class Found:
            frequencies_hz = solve_modes(beam, n_modes, count, wall="third-order").frequencies_hz
        return Found()

class Changed(Mine):
    def of(self, found):
        return found
    def solve_modes(self, beam, n_modes, count, **settings):
        inner = solve_modes(beam, n_modes, count)
        class Found:
            frequencies_hz = np.array(inner.frequencies_hz)
            def deflection(self, x):
                return inner.deflection(x)
        return self.of(Found())

class Short(Changed):
    def of(self, found):
        found.frequencies_hz = found.frequencies_hz[:-2]
        return found

class NotANumber(Changed):
    def of(self, found):
        found.frequencies_hz[3] = np.nan
        return found

class Fallen(Changed):
    def of(self, found):
        found.frequencies_hz[2] = 1.0
        return found

class Flat(Changed):
    def of(self, found):
        found.deflection = lambda x: np.zeros(len(x))
        return found

class Hole(Changed):
    def of(self, found):
        found.deflection = lambda x: np.full((len(found.frequencies_hz), len(x)), np.inf)
        return found

class Exchanged(Changed):
    def of(self, found):
        inner = found.deflection
        found.deflection = lambda x: inner(x)[[0, 1, 3, 2, *range(4, len(found.frequencies_hz))]]
        return found

class Raising(Mine):
    def solve_modes(self, beam, n_modes, count, **settings):
        raise ZeroDivisionError("no stiffness")

class Wordless(Changed):
    def of(self, found):
        return "done"

class Nothing(Model):
    name = "nothing"
"""


@pytest.fixture
def verify(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "others_models.py").write_text(MODEL)
    (tmp_path / "broken_models.py").write_text("1 / 0")

    def call(name, *words):
        status = status_of(["compare", "--model", name, "--scene", "steel-cantilever", *words])
        out, err = capsys.readouterr()
        return status, out, err

    return call


def test_a_model_is_judged_by_frequencies_and_shapes(verify):
    status, out, _ = verify("others_models:Mine", "--count", "25", "--json")
    data = json.loads(out)
    assert status == 0
    assert (data["best"]["wall"], data["best"]["order"], data["best"]["count"]) == ("half", 2, 25)
    assert len(data["modes"]) == 10
    assert min(row["likeness"] for row in data["modes"]) > 0.98


def test_a_class_with_nothing_but_frequencies_will_do(verify):
    status, out, _ = verify("others_models:Bare", "--count", "25", "--mode", "6", "--json")
    data = json.loads(out)
    assert status == 0
    assert (data["best"]["wall"], len(data["modes"])) == ("third-order", 6)


def test_a_model_that_exchanges_two_shapes_is_told_so(verify):
    status, out, _ = verify("others_models:Exchanged", "--count", "25", "--json")
    assert status == 1
    assert (
        "the columns of shapes are exchanged, the frequencies are not: modes 3, 4"
        in json.loads(out)["told"][0]["words"]
    )


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("others_models", "write it as package.module:Class"),
        ("no_such_module:Mine", "cannot be imported (No module named 'no_such_module')"),
        ("broken_models:Mine", "breaks when it is imported: ZeroDivisionError"),
        ("others_models:Yours", "others_models has no Yours"),
        ("others_models:Nothing", "has no solve_modes(beam, n_modes, count)"),
        ("json:JSONDecoder", "has no solve_modes(beam, n_modes, count)"),
        ("others_models:Short", "frequencies_hz has the shape (8,), and (10,) was asked for"),
        ("others_models:NotANumber", "frequencies_hz[3] is not finite"),
        ("others_models:Fallen", "1.0 lies below"),
        ("others_models:Flat", "deflection(x) has the shape (201,), and (10, 201) was asked for"),
        ("others_models:Hole", "deflection(x)[0, 0] is not finite"),
        ("others_models:Raising", "solve_modes raises ZeroDivisionError: no stiffness"),
        ("others_models:Wordless", "without frequencies_hz"),
    ],
)
def test_a_model_that_is_none_gets_one_sentence_and_status_2(verify, name, said):
    status, out, err = verify(name, "--count", "25")
    assert (status, out) == (2, "")
    assert said in err
    assert err.count("\n") == 1


def test_a_model_of_parts_needs_their_number(verify):
    status, _, err = verify("others_models:Mine")
    assert status == 2
    assert "count is missing: give --count" in err


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise SystemExit(0)", "solve_modes raises SystemExit"),
        ("return np.arange(1.0, n_modes + 1.0)", "without frequencies_hz"),
        ("return F(frequencies_hz=np.arange(1.0, n_modes + 1.0) * (3.0 + 1e-3j))", "frequencies_hz is complex"),
    ],
)
def test_a_model_that_leaves_or_answers_otherwise_is_one_sentence(tmp_path, monkeypatch, capsys, body, said):
    name = f"odd_{abs(hash(body))}"
    head = "import numpy as np\nfrom types import SimpleNamespace as F\nclass Mine:\n"
    (tmp_path / f"{name}.py").write_text(f"{head}    def solve_modes(self, beam, n_modes, count):\n        {body}\n")
    monkeypatch.chdir(tmp_path)
    assert status_of(["compare", "--model", f"{name}:Mine", "--count", "9", "--scene", "steel-cantilever"]) == 2
    told = capsys.readouterr()
    assert said in told.err
    assert (told.out, told.err.count("\n")) == ("", 1)


def test_what_a_model_prints_does_not_stand_in_the_json(tmp_path, monkeypatch, capsys):
    body = "        print('hello')\n        return solve_modes(beam, n_modes, count, wall='half')\n"
    head = "from verify.segments.linear import solve_modes\nprint('imported')\nclass Mine:\n"
    (tmp_path / "talks_much.py").write_text(f"{head}    def solve_modes(self, beam, n_modes, count):\n{body}")
    monkeypatch.chdir(tmp_path)
    given = ["compare", "--model", "talks_much:Mine", "--count", "12", "--scene", "steel-cantilever", "--json"]
    assert status_of([*given, "--mode", "4"]) == 0
    assert json.loads(capsys.readouterr().out)["best"]["wall"] == "half"
