"""Files of chains that are curved at rest or graded: the rod that they mean, by Ritz, and what deviates from it."""

import re

import numpy as np
import pytest

from tests.engines.test_chain_files import mujoco_hz
from tests.engines.test_curves import helix
from tests.reference.curved_rods import frequencies
from tests.reference.curved_rods import helix as ring_axes
from verify import Beam
from verify.answers.curves import curve_chain
from verify.engines.judgement import judge_file
from verify.errors import InputError
from verify.settings import wall_label

mujoco = pytest.importorskip("mujoco")
N, TURN, L, K, RHO = 16, 1.5, 0.02, 0.05, 1.2e3 * np.pi * 0.004**2
RADIUS = 0.5 * L / np.sin(0.5 * TURN / N)
"""Of the circle through the joints."""


def ring(stiffnesses, lengths=(L,) * N, held=False, rest="euler"):
    """MJCF of cylinders of 8 mm, each turned by TURN/N against the one before, by its body or by its spring."""
    text, before = "", 0.0
    for i, (k, length) in enumerate(zip(stiffnesses, lengths, strict=True)):
        angle = np.degrees(TURN / N) * (i > 0)
        turned, ref = (f'euler="0 0 {angle}"', "") if rest == "euler" else ("", f'springref="{angle}"')
        joint = "" if held and i == 0 else f'<joint name="j{i}" axis="0 0 1" stiffness="{k!r}" {ref}/>'
        text += f'<body pos="{before} 0 0" {turned}>{joint}<geom type="cylinder" size=".004" '
        text += f'fromto="0 0 0 {length} 0 0" mass="{RHO * length}" contype="0" conaffinity="0"/>'
        before = length
    return f'<mujoco><option gravity="0 0 0" timestep="1e-5"/><worldbody>{text}{"</body>" * len(lengths)}</worldbody></mujoco>'


def judged(path, text, **options):
    path.write_text(text)
    return judge_file(path, None, 3, **options)


def arc_hz(turn, radius):
    return frequencies(ring_axes(radius, 0), turn * radius, lambda s: [1e9, 1e9, K * L], lambda s: RHO)[:3] / (
        2 * np.pi
    )


@pytest.mark.parametrize("rest", ["euler", "spring"])
def test_the_rod_of_an_arc_and_the_wall_of_its_file(rest, tmp_path):
    out = tmp_path / "out.xml"
    found = judged(tmp_path / "arc.xml", ring([K] * N, rest=rest), corrected=out).data["chains"][0]
    assert (found["faults"], found["odd"]) == ([wall_label("full")], [])
    assert found["exact_hz"] == pytest.approx(arc_hz(TURN, RADIUS), rel=5e-5)
    if rest == "euler":
        assert found["frequencies_hz"] == pytest.approx(mujoco_hz(tmp_path / "arc.xml")[:3], rel=1e-7)
        errors = mujoco_hz(out)[:3] / found["exact_hz"] - 1.0
        assert abs(errors).max() < 0.2 * abs(found["error"]).max()
    stiffnesses = np.reshape(mujoco.MjModel.from_xml_path(str(out)).jnt_stiffness, (N, -1))[:, 0]
    assert stiffnesses[3:] == pytest.approx(K, rel=1e-12)
    assert abs(stiffnesses[:3] / K * [3 / 8, 7 / 6, 23 / 24] - 1.0).max() < 1e-3


def test_a_joint_off_the_law_is_named_and_nothing_is_rewritten(tmp_path):
    out = tmp_path / "out.xml"
    result = judged(tmp_path / "odd.xml", ring([K] * 6 + [0.4 * K] + [K] * 9), corrected=out)
    assert result.data["chains"][0]["odd"] == ["j6"]
    assert not result.data["passed"]
    assert not out.exists()


def test_half_links_at_both_ends_are_right_on_a_curve(tmp_path):
    """Rigid finite elements (Wittbrodt): the first half link is fixed, EI/l in all joints."""
    result = judged(tmp_path / "half.xml", ring([K] * 17, [L / 2, *[L] * 15, L / 2], held=True))
    found = result.data["chains"][0]
    assert (found["faults"], found["odd"], result.data["passed"]) == ([], [], True)
    assert 1e-4 < abs(found["error"]).max() < 1e-2


def test_two_stiffnesses_on_a_curve_are_steps(tmp_path):
    found = judged(tmp_path / "two.xml", ring([K] * 8 + [10 * K] * 8)).data
    assert found["chains"][0]["odd"] == []
    assert found["rules"] == ["bending: wall full (EI/l), EI stepped, 0.001 to 0.01 N m2"]


def test_a_file_in_space_means_its_rod(tmp_path):
    path, exact = helix(tmp_path / "helix.csv", points=240)
    curve_chain(path, 24, mode=3, path=tmp_path / "helix.xml")
    result = judge_file(tmp_path / "helix.xml", None, 3)
    (coupled,) = result.data["chains"]
    assert [one.split(":")[0] for one in result.data["rules"]] == ["bending", "width", "torsion"]
    assert coupled["exact_hz"] == pytest.approx(exact[:3], rel=3e-6)
    assert coupled["frequencies_hz"] == pytest.approx(mujoco_hz(tmp_path / "helix.xml")[:3], rel=1e-6)
    assert result.data["passed"]
    assert coupled["faults"] == []


def test_hinges_about_the_axes_of_one_link_are_of_order_one(tmp_path):
    """EI and GJ mix by half a rest angle; about the axes of the rod at the joints the order is four."""
    path, exact = helix(tmp_path / "helix.csv")
    errors = []
    for n in (20, 40):
        curve_chain(path, n, path=tmp_path / "helix.xml")
        text = (tmp_path / "helix.xml").read_text()
        for name, axis in (("bending", "0 -1 0"), ("width", "0 0 1"), ("torsion", "1 0 0")):
            text = re.sub(rf'(name="joint\d+_{name}" type="hinge" axis=")[^"]*"', rf'\g<1>{axis}"', text)
        (tmp_path / "links.xml").write_text(text)
        files = [mujoco_hz(tmp_path / name)[0] / exact[0] - 1.0 for name in ("links.xml", "helix.xml")]
        errors.append(files)
        (fault,) = judge_file(tmp_path / "links.xml", None, 3).data["chains"][0]["faults"]
        assert "off the axes of the rod" in fault
    assert np.log2(np.divide(*errors)) == pytest.approx([1.0, 4.1], abs=0.2)
    assert errors[0][0] > 1e3 * abs(errors[0][1])


def test_a_tapered_blade_needs_no_scene(tmp_path):
    n, length, text = 20, 0.5, ""
    width, thick = (lambda s: 0.03 * (1 - s)), (lambda s: 0.004 * (1 - 1.2 * s))
    for i in range(n):
        s, k = (i + 0.5) * length / n, i * length / n
        k = 7e10 * width(k) * thick(k) ** 3 / 12 / (length / n)
        text += f'<body pos="{length / n * (i > 0)} 0 0"><joint name="j{i}" axis="0 1 0" stiffness="{k!r}"/><geom type="box" '
        text += f'pos="{0.5 * length / n} 0 0" size="{0.5 * length / n} {width(s) / 2} {thick(s) / 2}" density="2700" '
        text += 'contype="0" conaffinity="0"/>'
    text = f'<mujoco><option gravity="0 0 0" timestep="1e-5"/><worldbody>{text}{"</body>" * n}</worldbody></mujoco>'
    found = judged(tmp_path / "blade.xml", text).data["chains"][0]
    stiff = lambda s: np.outer(width(s) * thick(s) ** 3, [1e18, 1e18, 7e10 / 12])  # noqa: E731
    axes, mass = (lambda s: np.tile(np.eye(3), (len(s), 1, 1))), (lambda s: 2700 * width(s) * thick(s))
    exact = frequencies(axes, length, stiff, mass)[:3] / (2 * np.pi)
    assert found["exact_hz"] == pytest.approx(exact, rel=2e-3)
    assert found["faults"] == [wall_label("full")]


def test_a_curve_is_no_straight_beam_and_has_a_clamp(tmp_path):
    path = tmp_path / "arc.xml"
    path.write_text(ring([K] * N))
    beam = Beam(length=N * L, bending_stiffness=1.0, mass_per_length=1.0, supports=("clamped", "free"))
    with pytest.raises(InputError, match="the beam is straight"):
        judge_file(path, beam)
    with pytest.raises(InputError, match="has no stiffness about an axis"):
        judged(path, ring([0.0, *[K] * 15]))
    with pytest.raises(InputError, match="follows no"):
        judged(path, ring((K * np.random.default_rng(3).uniform(0.5, 2.0, N)).tolist()))


def test_chords_are_right_below_the_limit_and_their_centres_are_the_remedy_above(tmp_path):
    """Of a chain of pieces with the centres of mass on the chords: order two in place of four."""
    path, exact = helix(tmp_path / "helix.csv", points=240)
    errors = {}
    for n in (12, 24):
        result = curve_chain(path, n, path=tmp_path / "pieces.xml")
        text = re.sub(r'(<inertial pos="\S+) [^"]*"', r'\1 0 0"', (tmp_path / "pieces.xml").read_text())
        (tmp_path / "chords.xml").write_text(text)
        for name in ("pieces", "chords"):
            errors[name, n] = mujoco_hz(tmp_path / f"{name}.xml")[0] / exact[0] - 1.0
        (table,) = (one for one in result.tables if one.title == "Frequencies")
        assert table.rows[0][4:] == pytest.approx((errors["pieces", n], errors["chords", n]), rel=0.02, abs=1e-6)
        coarse, fine = (judge_file(tmp_path / "chords.xml", None, 3, within=within) for within in (0.1, 1e-5))
        assert (coarse.data["passed"], fine.data["passed"]) == (True, False)
        assert coarse.data["chains"][0]["faults"] == []
        assert any("centres of mass" in one.remedy for one in fine.margins)
        pieces = judge_file(tmp_path / "pieces.xml", None, 3)
        assert not any("centres of mass" in one.remedy for one in pieces.margins)
    assert np.log2(errors["chords", 12] / errors["chords", 24]) == pytest.approx(2.0, abs=0.2)
    assert abs(errors["pieces", 24]) < 0.03 * abs(errors["chords", 24])
