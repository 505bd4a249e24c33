"""Chains in files of engines: each planted fault is named, its error is right, and the corrected file lacks it."""

import json
import re
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.engines.test_chain_files import PHRASE, STEEL, mujoco_hz
from verify import Beam, Section, SegmentModel
from verify.cli import status_of
from verify.engines.describe import describe
from verify.engines.judgement import judge_file
from verify.engines.writers import mjcf, write
from verify.errors import InputError
from verify.settings import wall_label

pytest.importorskip("mujoco")
DATA = Path(__file__).parent / "data"
STIFFNESS = re.compile(r"([sS]tiffness[\">=]+)[-+.\de]+")


def judged(tmp_path, text):
    """(chain, warnings, corrected file) of an MJCF text."""
    (tmp_path / "beam.xml").write_text(text)
    result = judge_file(tmp_path / "beam.xml", None, corrected=tmp_path / "out.xml")
    return result.data["chains"][0], result.warnings, tmp_path / "out.xml"


@pytest.mark.parametrize("suffix", ["xml", "sdf", "urdf"])
@pytest.mark.parametrize("wall", ["gregory", "half", "full", "third-order", "five-joint"])
def test_rule_at_the_wall_is_named_and_corrected_to_the_best_chain(tmp_path, wall, suffix):
    path, out, best = tmp_path / f"beam.{suffix}", tmp_path / f"out.{suffix}", describe(STEEL, 14)
    write(describe(STEEL, 14, wall=wall), path)
    found = judge_file(path, None, corrected=out).data["chains"][0]
    assert found["rule"] == wall_label(wall)
    assert bool(found["faults"]) == (wall != "gregory")
    assert found["stiffness"] == pytest.approx(358.4, rel=1e-9)
    assert found["error"] == pytest.approx(describe(STEEL, 14, wall=wall).errors(n_modes=5), abs=1e-9)
    again = judge_file(out, None)
    assert again.data["passed"]
    assert again.data["chains"][0]["frequencies_hz"] == pytest.approx(best.frequencies_hz(n_modes=5), rel=1e-9)
    assert STIFFNESS.sub(r"\1", out.read_text()) == STIFFNESS.sub(r"\1", path.read_text())
    if suffix == "xml":
        assert mujoco_hz(path)[:5] == pytest.approx(found["frequencies_hz"], rel=1e-9)
        assert mujoco_hz(out)[:5] == pytest.approx(best.frequencies_hz(n_modes=5), rel=1e-9)


@pytest.mark.parametrize("frame", [0.0, 0.5, 1.0])
def test_first_link_fixed_and_its_adapted_joints(tmp_path, frame):
    """The frame of the first link is at its beginning, its centre, its end."""
    text = re.sub(r'<joint name="joint0_.*?/>', "", mjcf(describe(STEEL, 14, wall="full")))
    text = re.sub('(?s)("link0" pos=")[^ ]+( .*?<inertial pos=")[^ ]+( .*?"link1" pos=")[^ ]+',
                  rf"\g<1>{frame / 14}\g<2>{(0.5 - frame) / 14}\g<3>{(1 - frame) / 14}", text)  # fmt: skip
    found, warnings, out = judged(tmp_path, text)
    assert found["faults"] == [wall_label("rigid")]
    assert (found["error"][0], found["corrected_error"][0]) == pytest.approx((0.0768, 1.04e-3), rel=0.02)
    assert "13380.3, 4300.8, 5235.76 N m/rad" in warnings[0]
    assert mujoco_hz(out)[0] / found["exact_hz"][0] - 1 == pytest.approx(found["corrected_error"][0], rel=1e-6)


def test_both_planes(tmp_path):
    path, out, best = tmp_path / "beam.xml", tmp_path / "out.xml", describe(STEEL, 14, in_space=True)
    write(describe(STEEL, 14, wall="full", in_space=True, damping=0.02), path)
    bending, width, _ = judge_file(path, STEEL, corrected=out).data["chains"]
    assert width["stiffness"] / bending["stiffness"] == pytest.approx(25.0)
    expected = [*best.frequencies_hz("bending", 3), *best.frequencies_hz("width", 1)]
    assert mujoco_hz(out)[:4] == pytest.approx(sorted(expected), rel=1e-9)


@pytest.mark.parametrize(("place", "factor", "fault"), [
    (0.5, 1 / 3, "inertia 0.333 m l^2 about the joint in place of m l^2/12"),
    (0.5, 1e-9, "point masses in place of m l^2/12"),
    (1.0, 1 / 12, "centre of mass at 1 l in place of l/2"),
])  # fmt: skip
def test_mass_models_are_named(tmp_path, place, factor, fault):
    inertia = factor * STEEL.mass_per_length / 14**3
    text = re.sub(r'diaginertia="[^"]*"', f'diaginertia="{inertia} {inertia} {inertia}"', mjcf(describe(STEEL, 14)))
    found, _, _ = judged(tmp_path, re.sub(r'<inertial pos="\S+', f'<inertial pos="{place / 14}', text))
    assert (found["faults"], found["mass_per_length"]) == ([fault], pytest.approx(2.512))


def test_springdamper_overrides_the_stiffness(tmp_path):
    text = re.sub('stiffness="[^"]*" damping="[^"]*"', 'springdamper="0.02 0.1"', mjcf(describe(STEEL, 14)))
    with pytest.raises(InputError, match="mj_saveLastXML"):
        judged(tmp_path, text)


def test_default_class_and_tip_mass(tmp_path):
    head = '<default><joint stiffness="5017.6"/></default>\n<worldbody><!-- <joint/> -->'
    text = mjcf(describe(STEEL, 14, wall="full")).replace("<worldbody>", head).replace('inertiafromgeom="false"', "")
    text = text.replace(' stiffness="5017.6" damping="0.0"', "")
    tip = '<body pos="0.0714 0 0"><geom size="0.01" mass="0.4"/></body><site name="tip"'
    found, _, out = judged(tmp_path, text.replace('<site name="tip"', tip))
    assert found["faults"] == [wall_label("full")]
    assert abs(found["corrected_error"][0]) < 2e-6
    bare = judge_file(out, STEEL)
    assert bare.data["chains"][0]["faults"] == ["bodies 0.4 kg heavier than those of the beam"]
    assert [margin.remedy[:14] for margin in bare.margins if margin.size > 1e-4] == ["give the links"]
    assert out.read_text().count("stiffness=") == 4


def test_public_models():
    round_bar = Beam(length=0.5, shape="round", diameter=0.01, youngs_modulus=70e9, density=2700.0,
                     supports=("clamped", "free"))  # fmt: skip
    beams = {"rod.xml": round_bar, "hose.xml": None, "tether.sdf": None}
    rod, hose, tether = (judge_file(DATA / name, beam).data["chains"] for name, beam in beams.items())
    square = "stiffness 1.6977 times that of the beam: a square section's for a round one"
    assert [text.split(",")[0] for text in rod[0]["faults"][:2]] == [wall_label("rigid"), square]
    assert hose[0]["faults"] == [
        wall_label("full"),
        "stiffness from the mean length in place of two half links in series",
    ]
    # bodies between two hinges at one place have 5 % of the mass and a quarter of the inertia
    assert [one["faults"][0] for one in tether] == [wall_label("full")] * 2
    assert [[text.split()[0] for text in one["faults"][1:]] for one in tether] == [["inertia", "centre"]] * 2
    assert any("cancel at mode 1" in text for text in judge_file(DATA / "hose.xml", None).warnings)
    errors = [one["error"][0] for one in (*rod, *hose, *tether)]
    assert errors == pytest.approx([0.3709, -0.0356, -0.1383, -0.1383], abs=1e-4)


def chain_text(n, joint, geom, step):
    """MJCF of n equal bodies along `step`, with gravity."""
    bodies = "".join(f'<body pos="{step if i else "0 0 0"}">{joint.format(i=i)}{geom}' for i in range(n))
    return f"<mujoco><worldbody>{bodies}{'</body>' * n}</worldbody></mujoco>"


def test_public_whip_of_point_masses_under_gravity(tmp_path):
    """mosesnah-shared/whip-project-targeting, models/25DOF_whip.xml: a point mass at the far joint of each link."""
    joint = '<joint name="j{i}" axis="0 -1 0" stiffness="0.242" damping="0.092"/>'
    geom = '<geom type="sphere" pos="0 0 -0.072" size="0.02" mass="0.012" contype="0" conaffinity="0"/>'
    found, _, out = judged(tmp_path, chain_text(25, joint, geom, "0 0 -0.072"))
    assert [text.split(" ")[0] for text in found["faults"]] == ["wall", "inertia", "centre"]
    assert (found["error"][0], found["corrected_error"][0]) == pytest.approx((-0.0748, -0.0384), abs=1e-4)
    weight = 25 * 0.012 * 9.81 * (25 * 0.072) ** 2 / (0.242 * 0.072)
    under = judge_file(out, None).margins
    assert f"{weight:.3g} EI/L^2" in under[1].failure
    assert under[2].remedy == "give the links the mass of the beam, m l^2/12 about l/2"


@pytest.mark.parametrize(("pose", "angle", "about", "axis"), [
    ("", "1.5707963267948966", "", "0 1 0"), (' degrees="true"', "90", "", "0 1 0"),
    ("", "1.5707963267948966", ' expressed_in="__model__"', "0 1 0"), ("", "1.5707963267948966", "", "1 0 0"),
    ("", "1.5707963267948966", ' expressed_in="__model__"', "0 0 1"),
])  # fmt: skip
def test_frames_of_sdf(tmp_path, pose, angle, about, axis):
    """Links along z of their own frame, which is pitched into x of the model."""
    text, parent, mass, spin = "", "world", 2.512 / 14, 2.512 / 14**3 / 12
    for i in range(14):
        text += f"""<link name="l{i}"><pose{pose}>{i / 14} 0 0 0 {angle} 0</pose><inertial><pose>0 0 {0.5 / 14}</pose>
            <mass>{mass}</mass><inertia><ixx>{spin}</ixx><iyy>{spin}</iyy><izz>0</izz></inertia></inertial></link>
            <joint name="j{i}" type="revolute"><parent>{parent}</parent><child>l{i}</child><axis><xyz{about}>{axis}</xyz>
            <dynamics><spring_stiffness>5017.6</spring_stiffness></dynamics></axis></joint>"""
        parent = f"l{i}"
    (tmp_path / "beam.sdf").write_text(f"<sdf><model>{text}</model></sdf>")
    found = judge_file(tmp_path / "beam.sdf", None).data["chains"][0]
    assert found["error"] == pytest.approx(describe(STEEL, 14, wall="full").errors(n_modes=5), abs=1e-9)


def test_beam_with_a_step_means_the_rod_of_its_links_or_a_scene(tmp_path):
    path = tmp_path / "beam.sdf"
    stepped = replace(STEEL, section=(Section(length=0.5), Section(length=0.5, thickness=0.004)))
    write(describe(stepped, 14, wall="full"), path)
    alone = judge_file(path, None).data["chains"][0]
    found = judge_file(path, stepped).data["chains"][0]
    assert alone["faults"] == [wall_label("full")]
    assert alone["exact_hz"] == pytest.approx(found["exact_hz"], rel=5e-4)
    assert found["faults"] == [wall_label("full")]
    assert found["error"] == pytest.approx(describe(stepped, 14, wall="full").errors(n_modes=5), abs=1e-9)


def test_half_a_link_fixed_at_the_wall_is_right_as_it_is(tmp_path):
    """Midpoint rule: joints l/2, 3l/2, ... from the wall with EI/l each, half a link at both ends; order 2."""
    text, joint = "", '<joint axis="0 1 0" stiffness="5017.6"/>'
    for i, length in enumerate([0.5 / 14, *[1 / 14] * 13, 0.5 / 14]):
        at = 0.5 * length
        text += (
            f'<body pos="{(0.5 + 0.5 * (i > 1)) / 14 * (i > 0)} 0 0">{joint * (i > 0)}<geom type="box" pos="{at} 0 0" '
        )
        text += f'size="{at} .02 .004" density="7850" contype="0" conaffinity="0"/>'
    found, warnings, out = judged(
        tmp_path, f"<mujoco><option timestep='1e-5'/><worldbody>{text}{'</body>' * 15}</worldbody></mujoco>"
    )
    assert (found["faults"], len(warnings)) == ([], 1)
    assert found["rule"] == "fixed link in series with its joint at the wall"
    assert found["stiffness"] == pytest.approx(358.4, rel=1e-9)
    welded = SegmentModel(STEEL, 14, wall="welded").modes(2).frequencies_hz
    assert found["frequencies_hz"][:2] == pytest.approx(welded, rel=2e-4)  # geoms have rotary inertia
    assert out.read_bytes() == (tmp_path / "beam.xml").read_bytes()


def test_ball_joints_and_the_modulus_of_round_links_are_named(tmp_path):
    joint = '<joint type="ball" stiffness="2333.3333"/>'
    geom = '<geom type="cylinder" fromto="0 0 0 .025 0 0" size=".005" density="2700" contype="0" conaffinity="0"/>'
    found, warnings, out = judged(tmp_path, chain_text(20, joint, geom, ".025 0 0"))
    assert found["faults"] == [wall_label("full")]
    assert "a ball joint is read as three hinges" in warnings[0]
    assert "E = 118.8 GPa, or 70 GPa if it is a square section's" in warnings[1]
    again = judge_file(out, None)
    assert again.data["passed"]
    assert [one["rule"] for one in again.data["chains"]] == [wall_label("gregory")] * 2


HINGE = (
    '<body pos="{x} 0 0"><joint name="j{x}" axis="0 1 0" stiffness="{k}"/><geom size=".1" pos=".1 0 0"/>{more}</body>'
)
PAIR = HINGE.format(x=0, k=5, more=HINGE.format(x=0.2, k=5, more="{}"))
END = HINGE.format(x=0.21, k=5, more="")


@pytest.mark.parametrize(("body", "sentence"), [
    (PAIR.format(END + END.replace("j0", "i")), "the chain branches"),
    (PAIR.format(HINGE.format(x=0.21, k=0, more="")), "has no hinge with a stiffness"),
    (HINGE.format(x=0, k=0, more=""), "no hinge has a stiffness"),
    (HINGE.format(x=0, k=5, more=""), "two links or more"),
    (PAIR.format("").replace("axis", 'type="slide" axis', 1), "a slide or a free base"),
    (PAIR.format(END) + '</worldbody><tendon><fixed damping="1"><joint joint="j0" coef="1"/></fixed></tendon><worldbody>',
     "has a tendon"),
    (PAIR.format(END.replace(" 0 0", " .1 0", 1)), "off the lines between its joints"),
    (PAIR.format("") + '</worldbody><equality><joint joint1="j0"/></equality><worldbody>', "has an equality"),
    ("<body><joint/><geom/></body>", "size 0 must be positive in geom"),
    (re.sub(r"(<joint[^>]*/>)(<geom[^>]*/>)(<body.*</body>)</body>$", r"\2\3\1</body>", PAIR.format("")),
     "not in its text in order"),
])  # fmt: skip
def test_what_is_no_chain_is_one_sentence(tmp_path, body, sentence, capsys):
    text = f'<mujoco><option><flag contact="disable"/></option><worldbody>{body}</worldbody></mujoco>'
    with pytest.raises(InputError, match=sentence):
        judged(tmp_path, text)
    assert status_of(["compare", str(tmp_path / "beam.xml"), "--corrected", str(tmp_path / "out.xml")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_command_and_files_without_springs(tmp_path, capsys):
    path = tmp_path / "beam.urdf"
    assert status_of(["export", "--beam", PHRASE, "--count", "14", "--to", str(path)]) == 0
    assert status_of(["compare", str(path), str(path)]) == 2
    assert "give one file" in capsys.readouterr().err
    assert status_of(["compare", str(path), "--corrected", str(tmp_path / "out.xml")]) == 2
    assert "the format stays" in capsys.readouterr().err
    write(describe(STEEL, 14, wall="half"), path)
    assert status_of(["compare", "--beam", PHRASE, str(path), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["chains"][0]["rule"] == wall_label("half")
    path.write_text(re.sub("<gazebo.*?</gazebo>", "", path.read_text()))
    assert status_of(["compare", str(path)]) == 2
    assert "no hinge has a stiffness" in capsys.readouterr().err
