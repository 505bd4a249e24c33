"""Files of chains that are curved at rest or graded: the rod that they mean, by Ritz, and what deviates from it."""

import re

import numpy as np
import pytest

from tests.engines.test_chain_files import PHRASE, mujoco_hz
from tests.engines.test_curves import helix, table
from tests.reference.curved_rods import frequencies
from tests.reference.curved_rods import helix as ring_axes
from verify import Beam
from verify.answers.curves import curve_chain
from verify.cli import status_of
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


def edited(chain, find, change, lone="", count=0):
    """MJCF with `change` of the groups of `find`, in all bodies or from the name of a `lone` joint on."""
    at = chain.index(f'name="{lone}"') if lone else 0
    return chain[:at] + re.sub(find, change, chain[at:], count=count)


def times(factor):
    return lambda found: f"{found[1]}{' '.join(repr(factor * float(one)) for one in found[2].split())}{found[3]}"


INERTIA, STIFFNESS, MASS = (rf'({name}=")([^"]*)(")' for name in ("diaginertia", "stiffness", "mass"))
AXIS, SHIFT = r'(name="joint7_torsion" type="hinge" axis=")[^"]*(")', r'(<inertial pos=")(\S+)( [^"]*")'
FAULTS = {  # find, change, joint before it, bodies; what is named, largest relative error
    "inertia": (INERTIA, times(10.0), "joint7_torsion", 1, "inertia of the link of joint7_bending (10 times)", 1e-3),
    "inertias": (INERTIA, times(10.0), "", 0, "inertia 0.833 m l^2 in place of m l^2/12", 0.1),
    "mass": (MASS, times(1.2), "joint7_torsion", 1, "mass of the link of joint7_bending (1.2 times)", 0.02),
    "far joint": (SHIFT, times(2.0), "", 0, "centre of mass at 0.997 l in place of l/2", 0.1),
    "width": (STIFFNESS, times(2.0), "joint7_width", 1, "joint7_width (2 times)", 0.02),
    "axis": (AXIS, r"\g<1>0.9962 0.0872 0\2", "", 1, "hinge off the axes of the rod: joint7_torsion", 0.01),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_one_planted_fault_is_named_with_its_joint_and_nothing_else_is(fault, tmp_path):
    find, change, lone, count, named, largest = FAULTS[fault]
    path, _ = helix(tmp_path / "helix.csv", points=240)
    curve_chain(path, 20, path=tmp_path / "right.xml")
    text = edited((tmp_path / "right.xml").read_text(), find, change, lone, count)
    out = tmp_path / "out.xml"
    result = judged(tmp_path / "wrong.xml", text, corrected=out, within=1e-4)
    found = result.data["chains"][0]
    (only,) = found["faults"]
    assert named in only
    assert not result.data["passed"]
    assert 1e-4 < abs(found["error"]).max() < largest
    assert found["frequencies_hz"] == pytest.approx(mujoco_hz(tmp_path / "wrong.xml")[:3], rel=1e-6)
    if fault == "width":
        right = float(re.search(r'joint7_width"[^>]* stiffness="([^"]*)"', (tmp_path / "right.xml").read_text())[1])
        assert f"joint7_width to {right:.4g}"[:-1] in " ".join(one.remedy for one in result.margins)
    assert not out.exists() or mujoco_hz(out)[:3] == pytest.approx(found["frequencies_hz"], rel=1e-9)


@pytest.mark.parametrize("fault", ["lost", "all lost", "spring"])
@pytest.mark.parametrize("space", [True, False])
def test_a_lost_rest_angle_shows_at_centres_of_mass_or_hinges(fault, space, tmp_path):
    """The file runs at the frequencies of another curve, and errors against that one are small."""
    angle = np.linspace(0.0, 1.6, 90)
    csv = table(tmp_path / "arc.csv", x=0.3 * np.sin(angle), y=0.3 * (1 - np.cos(angle)), EI=2.0, EI2=3.0, GJ=1.5,
                rho_A=0.7, rho_Ip=1e-5)  # fmt: skip
    curve_chain(csv, 40, in_space=space, path=tmp_path / "right.xml")
    text = (tmp_path / "right.xml").read_text()
    assert judge_file(tmp_path / "right.xml", None, 3, within=1e-3).data["passed"]
    quat = r' quat="[^"]*"'
    if fault == "spring":
        text = re.sub(r'(name="joint9_bending"[^>]*)/>', r'\1 springref="0.15"/>', text)
    else:
        text = re.sub(quat if fault == "all lost" else f'(name="link9"[^>]*?){quat}', r"\1" * (fault == "lost"), text)
    result = judged(tmp_path / "wrong.xml", text, corrected=tmp_path / "out.xml")
    assert not result.data["passed"]
    assert (
        "the angles of the curve" in result.margins[0].remedy or "the angles of the curve" in result.margins[1].remedy
    )
    assert ("joint9_bending" in " ".join(one.failure for one in result.margins)) == (fault != "all lost")
    assert any("springref" in one for one in result.warnings) == (fault == "spring")
    assert not (tmp_path / "out.xml").exists()


def test_free_hinges_and_those_off_a_plane_are_named(tmp_path):
    path, _ = helix(tmp_path / "helix.csv")
    curve_chain(path, 20, path=tmp_path / "helix.xml")
    free = re.sub(r'(_torsion"[^>]*stiffness=")[^"]*"', r'\g<1>0"', (tmp_path / "helix.xml").read_text())
    with pytest.raises(InputError, match="'joint0_torsion' and all others like it have no stiffness"):
        judged(tmp_path / "free.xml", free)
    with pytest.raises(InputError, match=r"the hinge of 'j5' is 5\.7 degrees off the normal"):
        judged(tmp_path / "off.xml", re.sub('(name="j5" axis=")0 0 1', r"\g<1>0.1 0 1", ring([K] * N)))


@pytest.mark.parametrize("n", [13, 20])
def test_steps_of_mass_and_stiffness_lie_inside_a_link_or_at_a_joint(n, tmp_path):
    """The reference is that of the chain's own table: with 13 links the step is in the middle of one."""
    angle = np.append(np.linspace(0.0, 0.75, 20), np.linspace(0.75, 1.5, 20))
    tip = np.arange(40) >= 20
    for drop in (0.003, 0.5):
        csv = table(tmp_path / "step.csv", x=0.3 * np.sin(angle), y=0.3 * (1 - np.cos(angle)),
                    EI=np.where(tip, 0.8, 2.0), rho_A=np.where(tip, 0.7 * (1 - drop), 0.7))  # fmt: skip
        made = curve_chain(csv, n, error=0.1, path=tmp_path / "step.xml").data["expected"]["bending"]
        found = judge_file(tmp_path / "step.xml", None, 3, within=0.01).data
        (bending,) = found["chains"]
        assert bending["exact_hz"] == pytest.approx(made["frequencies_hz"] / (1 + made["error"]), rel=1e-4)
        assert (bending["faults"], bending["odd"], found["passed"]) == ([], [], True)


@pytest.mark.parametrize("law", ["stepped", "smooth"])
@pytest.mark.parametrize("joint", [1, 2, 7])
def test_a_joint_off_a_law_that_varies_has_the_stiffness_by_it(joint, law, tmp_path):
    """At the wall it is on the rule of the others; two joints behind it are too few for a piece of their own."""
    angle = np.append(np.linspace(0.0, 0.75, 20), np.linspace(0.75, 1.5, 20))
    ei = 2.0 - 0.9 * angle if law == "smooth" else np.where(np.arange(40) < 20, 2.0, 0.5)
    csv = table(tmp_path / "arc.csv", x=0.3 * np.sin(angle), y=0.3 * (1 - np.cos(angle)), EI=ei, rho_A=0.7)
    curve_chain(csv, 20, path=tmp_path / "right.xml")
    text, name = (tmp_path / "right.xml").read_text(), f"joint{joint}_bending"
    right = float(re.search(rf'{name}"[^>]* stiffness="([^"]*)"', text)[1])
    result = judged(
        tmp_path / "wrong.xml", edited(text, STIFFNESS, times(1.8), name, 1), corrected=tmp_path / "out.xml"
    )
    (found,) = result.data["chains"]
    assert (found["odd"], result.data["passed"]) == ([name], False)
    (remedy,) = {one.remedy for one in result.margins if name in one.remedy}
    assert float(re.search(f"{name} to (\\S+)", remedy)[1]) == pytest.approx(right, rel=5e-3)
    assert 0.01 < abs(found["error"]).max() < 0.06
    assert not (tmp_path / "out.xml").exists()


UNEVEN = np.append(0.0, np.cumsum(np.random.default_rng(21).uniform(0.6, 1.6, 21)))
SHAPES = {  # angle of the tangent by f = s/L, height, columns by f, points, links
    "spiral": (lambda f: 5.0 * f**2, 0.0, lambda f: {"EI": 2.0 - 1.2 * f, "rho_A": 0.4 - 0.2 * f}, UNEVEN / UNEVEN[-1], None),
    "cane": (lambda f: np.clip(f / 0.45 - 11 / 9, 0, 1) * np.pi, 0.0, lambda f: {"EI": 2.0, "rho_A": 0.4},
             np.linspace(0.0, 1.0, 9) ** 1.3, None),
    "hook": (lambda f: 3.4 * np.clip(f / 0.6 - 2 / 3, 0, 1), 0.17, lambda f: {"EI": 2.0, "EI2": 3.1, "GJ": 1.4, "rho_A": 0.4,
             "rho_Ip": 3e-5, "roll": -70.0 * f}, np.linspace(0.0, 1.0, 161), 8),
}  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
def test_few_or_unequal_links_of_a_sharp_or_tapered_curve_have_no_fault(shape, tmp_path):
    """What a spline through the joints does not know of the curve is no fault of the file."""
    angle, height, columns, f, count = SHAPES[shape]
    fine = np.linspace(0.0, 1.0, 4001)
    middle = 0.5 * (fine[1:] + fine[:-1])
    step = np.stack([np.cos(angle(middle)), np.sin(angle(middle)), 2.0 * height * middle], axis=1) / 4000
    places = np.vstack([np.zeros(3), np.cumsum(step, axis=0)])
    x, y, z = (np.interp(f, fine, one) for one in places.T)
    path = table(tmp_path / "rod.csv", x=x, y=y, **({"z": z} if height else {}), **columns(f))
    curve_chain(path, count, error=0.5, path=tmp_path / "rod.xml")
    found = judge_file(tmp_path / "rod.xml", None, 3, within=0.5).data["chains"][0]
    assert ([one for one in found["faults"] if one != wall_label("half")], found["odd"]) == ([], [])
    assert found["frequencies_hz"] == pytest.approx(mujoco_hz(tmp_path / "rod.xml")[:3], rel=1e-6)


def test_few_links_show_no_law(tmp_path):
    with pytest.raises(InputError, match=r"too few to tell a law of it from a fault: give 10 links or more$"):
        judged(tmp_path / "few.xml", ring([K, K, 2 * K], lengths=(L,) * 3))


def test_a_verdict_counts_the_mode_that_is_farthest_off(tmp_path):
    """Of centres of mass on the chords of an arc that is mode 1, as in the exit status."""
    angle = np.linspace(0.0, 1.6, 90)
    csv = table(tmp_path / "arc.csv", x=0.3 * np.sin(angle), y=0.3 * (1 - np.cos(angle)), EI=2.0, rho_A=0.7)
    curve_chain(csv, 20, path=tmp_path / "arc.xml")
    text = re.sub(r'(<inertial pos="\S+) [^"]*"', r'\1 0 0"', (tmp_path / "arc.xml").read_text())
    result = judged(tmp_path / "chords.xml", text, within=3e-4)
    errors = abs(result.data["chains"][0]["error"])
    assert errors[0] > 1.5 * errors[2]
    assert max(one.size for one in result.margins if "links" in one.name) == pytest.approx(errors[0], rel=1e-9)


def test_flags_and_equalities_are_those_of_the_run(tmp_path):
    text = (
        ring([K] * N)
        .replace("<worldbody>", '<worldbody><body name="b"/>', 1)
        .replace("<option", '<option timestep="1e-5"', 0)
    )
    for flag in ("spring", "gravity"):
        changed = text.replace(
            'gravity="0 0 0" timestep="1e-5"/>', f'timestep="1e-5"><flag {flag}="disable"/></option>'
        )
        if flag == "spring":
            with pytest.raises(InputError, match="no hinge has a stiffness"):
                judged(tmp_path / "flag.xml", changed)
        else:
            assert not any(one.name == "gravity" for one in judged(tmp_path / "flag.xml", changed).margins)
    path, _ = helix(tmp_path / "helix.csv")
    curve_chain(path, 12, path=tmp_path / "helix.xml")
    loop = '<equality><connect body1="link9" body2="link3" anchor="0 0 0"/>'
    with pytest.raises(InputError, match="'joint4_bending' has an equality"):
        judged(tmp_path / "loop.xml", (tmp_path / "helix.xml").read_text().replace("<equality>", loop))


@pytest.mark.parametrize("name", ["arc.json", "arc_exudyn.py", "arc.urdf.json"])
def test_what_chain_writes_and_compare_does_not_read_has_one_sentence(name, tmp_path, capsys):
    csv = table(tmp_path / "arc.csv", x=np.sin(np.linspace(0, 1, 9)), y=np.cos(np.linspace(0, 1, 9)), EI=2.0, rho_A=0.7)
    curve_chain(csv, 8, error=0.3, path=tmp_path / name.replace(".urdf.json", ".urdf"))
    assert status_of(["compare", str(tmp_path / name)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert ".xml" in said.replace(str(tmp_path), "")
    assert ("run it" in said) == name.endswith(".py")
    (tmp_path / "list.json").write_text("[6.366, 39.946, 111.985]")
    assert status_of(["compare", "--beam", PHRASE, str(tmp_path / "list.json"), "--count", "20"]) == 1
