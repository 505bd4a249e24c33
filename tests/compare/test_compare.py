"""Lists of natural frequencies from other codes and from dense matrices, identified; faults of lists, diagnosed."""

import numpy as np
import pytest
from reference.discrete_beams import links_without_inertia, lumped_elements, lumped_rod, rigid_links, stepped_chain
from shared_lists import CANTILEVER, FREE, HELD, PROPPED, STEPPED, STRIP, compared, exudyn, recorded, table

from tests.beams import PAPER
from verify.compare.candidates import EXACT, Candidate, candidates, frequencies_hz
from verify.compare.compare import Options, compare
from verify.compare.effects import varied
from verify.compare.reading import ModeShapes, listed
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointMass
from verify.segment_model import SegmentModel

LUMPED = tuple(lumped_rod(PAPER, 49)[:22])


def best(result, *names):
    return tuple(result.data["best"][name] for name in names)


def exact_hz(beam, n, theory="euler-bernoulli"):
    return frequencies_hz(Candidate(model=EXACT, theory=theory), beam, None, n)


class TestRecordedLists:
    """Exudyn 1.13.6, MuJoCo 4.0.0, PyElastica 1.0.0."""

    @pytest.mark.parametrize("count", [30, None])
    def test_exudyn_chain_has_2ei_l_at_the_wall(self, count):
        result = recorded("exudyn-cantilever.csv", CANTILEVER, count=count)
        assert result.data["status"] == "identified"
        assert best(result, "mass", "wall", "theory", "order", "count") == ("links", "half", "euler-bernoulli", 2, 30)
        assert best(result, "rms")[0] < 1e-9
        assert table(result, "Modes")[7]["error"] == pytest.approx(-0.008887, abs=1e-6)
        assert table(result, "Required N")[0]["N for 0.1 %"] == 89
        assert result.data["passed"]

    def test_mujoco_chain_is_of_order_four(self):
        result = recorded("mujoco-paper.tsv", PAPER, count=49)
        assert (result.data["unit"], result.data["status"]) == ("rad/s", "identified")
        assert best(result, "mass", "wall", "order", "count") == ("links", None, 4, 49)
        assert table(result, "Modes")[21]["error"] == pytest.approx(-0.00428024, abs=5e-8)
        assert [one["mass"] for one in result.data["equivalent"]] == ["lumped"]
        assert table(result, "Required N")[0]["N for 0.1 %"] == 68

    def test_pyelastica_rod_has_lumped_mass(self):
        result = recorded("pyelastica-paper.txt", PAPER, count=49)
        assert result.data["status"] == "identified"
        assert best(result, "mass", "theory", "order", "count") == ("rod", "timoshenko", 2, 49)
        assert table(result, "Modes")[21]["error"] == pytest.approx(-0.157552, abs=2e-6)
        assert [one["N for 0.1 %"] for one in table(result, "Required N")][:2] == [630, 68]


MEMBERS = {
    "lumped chain": (PAPER, LUMPED, 49, ("joints", None, 2)),
    "point masses": (PAPER, links_without_inertia(PAPER, 49)[:22], 49, ("points", None, 2)),
    "free chain": (FREE, lumped_rod(FREE, 40)[2:10], 40, ("joints", None, 2)),
    "EI/l at the wall": (CANTILEVER, rigid_links(CANTILEVER, 30, wall=1.0)[:8], 30, ("links", "full", 1)),
    "4EI/l at the wall": (CANTILEVER, rigid_links(CANTILEVER, 30, wall=4.0)[:8], 30, ("links", "stiff", 1)),
    "HRZ": (PROPPED, lumped_elements(PROPPED, 25, 1 / 78)[:9], 25, ("hrz", None, 2)),
    **{
        rule: (STEPPED, stepped_chain(STEPPED, (20, 28), rule)[:8], 48, ("links", "half", 1))
        for rule in ("printed", "outboard", "inboard", "mean")
    },
    "2EI/l at both walls": (HELD, rigid_links(HELD, 21)[:8], 21, ("links", "half", 2)),
    "exact beam": (CANTILEVER, exact_hz(CANTILEVER, 8), None, ("", None, None)),
}


@pytest.mark.parametrize("name", MEMBERS)
def test_member_is_identified(name):
    beam, hertz, count, expected = MEMBERS[name]
    result = compared(beam, hertz, count=count, within=1.0)
    assert best(result, "mass", "wall", "order") == expected
    assert best(result, "rms")[0] < 1e-13
    assert result.data["best"]["fault"]["kind"] == "none"
    assert result.data["passed"]
    assert best(result, "joints")[0] == (name if beam is STEPPED else "series")


def test_lumped_elements_equal_the_2ei_l_chain():
    """On a cantilever the moments of one are the deflections of the other; the kind says which was built."""
    hertz = lumped_elements(CANTILEVER, 30)[:8]
    assert best(compared(CANTILEVER, hertz, count=30), "wall") == ("half",)
    assert best(compared(CANTILEVER, hertz, count=30, kind="elements"), "mass") == ("lumped",)


@pytest.mark.parametrize("beam", [CANTILEVER, PROPPED, PAPER], ids=lambda beam: "-".join(beam.supports))
def test_candidates_converge_at_their_orders(beam):
    """Of Gregory's and the five-joint weights the error changes sign at these sizes."""
    for one in candidates(beam):
        exact = exact_hz(beam, 2, one.theory)[1]
        if not one.sized or one.theory != "euler-bernoulli" or one.wall in ("gregory", "five-joint"):
            continue
        errors = [abs(frequencies_hz(one, beam, n, 2)[1] / exact - 1.0) for n in (40, 80)]
        if max(errors) > 1e-9:
            assert np.log2(errors[0] / errors[1]) == pytest.approx(one.order(beam), abs=0.15), one.label


class TestFaults:
    """One fault each."""

    @pytest.mark.parametrize(("factor", "label"), [(2 * np.pi, "rad/s"), (1e-3, "kHz"), (60.0, "1/min")])
    def test_wrong_unit(self, factor, label):
        result = compared(PAPER, factor * np.array(LUMPED), count=49)
        assert (result.data["unit"], result.data["status"]) == (label, "identified")
        assert best(result, "mass") == ("joints",)
        declared = listed("list", (factor * np.array(LUMPED)).tolist(), declared=True)
        result = compare(
            type("Scene", (), {"name": "beam", "beam": PAPER}), declared, None, Options(count=49, within=1.0)
        )
        assert f"The values are in {label}, not in Hz." in result.warnings
        assert not result.data["passed"]

    @pytest.mark.parametrize("mode", [1, 21])
    def test_missing_mode(self, mode):
        result = compared(PAPER, np.delete(LUMPED, mode - 1), count=49)
        assert result.data["best"]["fault"] == {"kind": "missing", "label": f"mode {mode}", "parameter": 1.0}
        assert [row["read as mode"] for row in table(result, "Modes")] == [m for m in range(1, 23) if m != mode]

    def test_extra_entry(self):
        hertz = np.sort([*LUMPED[:14], 0.6 * LUMPED[7] + 0.4 * LUMPED[8]])
        result = compared(PAPER, hertz, count=49)
        assert result.data["best"]["fault"]["label"] == "entry 9"
        assert best(result, "mass", "count") == ("joints", 49)

    def test_common_factor(self):
        result = compared(PAPER, np.sqrt(1.03) * np.array(LUMPED), count=49)
        fault = result.data["best"]["fault"]
        assert (fault["kind"], fault["parameter"]) == ("factor", pytest.approx(np.sqrt(1.03), rel=1e-6))
        changes = {row["parameter"]: row["change"] for row in table(result, "Parameters that alone explain the factor")}
        assert changes["E"] == pytest.approx(0.03, rel=1e-5)
        assert changes["length"] == pytest.approx(1.03**-0.25 - 1.0, rel=1e-4)

    @pytest.mark.parametrize("model", ["segment", "fem"])
    def test_compliant_clamp(self, model):
        soft = varied(CANTILEVER, "clamp", ("left",), 37.0)
        built = SegmentModel(soft, 30, wall="half") if model == "segment" else HermiteModel(soft, 30)
        modes = built.modes(8)
        result = compared(CANTILEVER, modes.frequencies_hz, count=30)
        fault = result.data["best"]["fault"]
        assert (fault["kind"], fault["label"]) == ("clamp", "left")
        assert fault["parameter"] == pytest.approx(37.0, rel=1e-3)
        assert best(result, "model") == (model,)
        assert any("mass rho A L / c" in warning for warning in result.warnings)

    def test_rigid_motions_of_a_clamped_beam(self):
        result = compared(PROPPED, [0.0, 1e-4, *rigid_links(PROPPED, 37)[:8]], count=37)
        assert "starts with 2 rigid-body motions, the beam of the scene has 0" in result.warnings[0]
        assert best(result, "wall") == ("half",)
        assert [row["entry"] for row in table(result, "Modes")] == list(range(3, 11))
        assert not result.data["passed"]

    def test_other_supports(self):
        result = compared(CANTILEVER, exact_hz(PROPPED, 8), count=30)
        assert result.data["status"] == "unknown"
        assert "other supports: pinned-clamped" in result.warnings[0]


class TestShapes:
    """Shapes of the Exudyn chain."""

    def swapped(self, order):
        hertz, x, shapes = exudyn()
        scene = type("Scene", (), {"name": "beam", "beam": CANTILEVER})
        given = listed("list", hertz[order].tolist())
        return compare(scene, given, ModeShapes(x=x, values=shapes[order]), Options(count=30))

    def test_shapes_pair_the_modes(self):
        result = self.swapped([0, 1, 2, 3, 4, 5, 6, 7])
        assert min(row["MAC"] for row in table(result, "Modes")) == pytest.approx(0.9963, abs=1e-4)
        assert result.data["passed"]

    def test_exchanged_modes_are_paired(self):
        result = self.swapped([0, 1, 3, 2, 4, 5, 6, 7])
        assert [row["entry"] for row in table(result, "Modes")] == [1, 2, 4, 3, 5, 6, 7, 8]
        assert best(result, "wall", "order") == ("half", 2)
        assert "not in the order" in result.warnings[0]

    def test_missing_mode_is_known_by_shape(self):
        result = self.swapped([0, 1, 2, 4, 5, 6])
        assert [row["mode"] for row in table(result, "Modes")] == [1, 2, 3, 5, 6, 7]
        assert result.data["best"]["fault"]["kind"] == "none"


def test_body_between_the_joints():
    """Errors of a body on a rigid link change with where it falls within the link."""
    beam = Beam(**STRIP, supports=("clamped", "free"), mass=(PointMass(position=0.21, mass=0.03),))
    hertz = SegmentModel(beam, 23, attachment="lever").modes(6).frequencies_hz
    result = compared(beam, hertz, count=23)
    assert best(result, "attachment", "count") == ("lever", 23)


@pytest.mark.parametrize(
    ("hertz", "options", "message"),
    [
        ([30.0, 20.0], {}, "do not ascend"),
        ([0.0, 0.0], {}, "no elastic mode"),
        ([-1.0], {}, "finite numbers from 0"),
        (exudyn()[0], {"count": 1}, "raise count"),
        (exudyn()[0], {"mode": 0}, "mode = 0"),
    ],
)
def test_bad_lists_raise_one_sentence(hertz, options, message):
    with pytest.raises(InputError, match=message):
        compared(CANTILEVER, hertz, **options)
