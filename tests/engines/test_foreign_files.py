"""Files of other people: unequal joints, sections that lie the other way, formats and typing errors."""

import re
import warnings

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh

from tests.engines.test_chain_files import STEEL, mujoco_hz, springs_beside
from tests.engines.test_judgement import chain_text
from verify import Beam
from verify.cli import status_of
from verify.engines.describe import describe
from verify.engines.judgement import judge_file
from verify.engines.writers import mjcf, write
from verify.errors import InputError
from verify.settings import wall_label

mujoco = pytest.importorskip("mujoco")
N, K, MASS = 20, 0.0785398, 0.0785398
"""Links of 25 mm, N m/rad, kg/m: a rod of 10 mm."""
STRIP = replace(STEEL, length=0.7, width=0.025, thickness=0.003, youngs_modulus=206e9)


def rod(stiffnesses, lengths=(0.5 / N,) * N, mass=MASS):
    """MJCF of cylinders along x with hinges y0, y1, ..."""
    text, end = "", 0.0
    for i, (k, length) in enumerate(zip(stiffnesses, lengths, strict=True)):
        text += f'<body pos="{end} 0 0"><joint name="y{i}" axis="0 1 0" stiffness="{k!r}"/><geom type="cylinder" '
        text += f'size=".005" fromto="0 0 0 {length} 0 0" mass="{mass * length}" contype="0" conaffinity="0"/>'
        end = length
    return f'<mujoco><option gravity="0 0 0"/><worldbody>{text}{"</body>" * len(lengths)}</worldbody></mujoco>'


def cantilever_hz(stiffness, length=0.5, n=400):
    """First three frequencies by n Hermite elements of the EI in their middles."""
    h, scale = length / n, np.diag([1.0, length / n] * 2)
    own = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
    heavy = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    stiff, mass = np.zeros((2, 2 * n + 2, 2 * n + 2))
    for i in range(n):
        at = slice(2 * i, 2 * i + 4)
        stiff[at, at] += stiffness((i + 0.5) * h) / h**3 * scale @ own @ scale
        mass[at, at] += MASS * h / 420 * scale @ heavy @ scale
    return np.sqrt(eigh(stiff[2:, 2:], mass[2:, 2:], eigvals_only=True)[:3]) / (2 * np.pi)


EI = K * 0.5 / N
TAPER = [10 * K * (1 - 0.9 * j / N) for j in range(N)]
UNEQUAL = {  # stiffnesses, EI along the beam, joints off it
    "two halves": ([K] * 10 + [10 * K] * 10, lambda x: EI if x < 0.25 else 10 * EI, ["y10"]),
    "step in series": ([K] * 10 + [20 / 11 * K] + [10 * K] * 9, lambda x: EI if x < 0.25 else 10 * EI, []),
    "taper": (TAPER, lambda x: 10 * EI * (1 - 0.9 * x / 0.5), []),
    "one soft": ([K] * 9 + [0.2 * K] + [K] * 10, lambda x: EI, ["y9"]),
    "soft next to the wall": ([K, 0.2 * K, *[K] * 18], lambda x: EI, ["y1"]),
    "taper, one soft": ([*TAPER[:13], 0.3 * TAPER[13], *TAPER[14:]], lambda x: 10 * EI * (1 - 0.9 * x / 0.5), ["y13"]),
}


@pytest.mark.parametrize("case", UNEQUAL)
def test_unequal_joints_are_a_law_and_those_off_it(case, tmp_path):
    stiffnesses, along, odd = UNEQUAL[case]
    (tmp_path / "rod.xml").write_text(rod(stiffnesses))
    found = judge_file(tmp_path / "rod.xml", None, 3, corrected=tmp_path / "out.xml").data["chains"][0]
    assert found["odd"] == odd
    assert found["faults"][0] == wall_label("full")
    assert found["exact_hz"] == pytest.approx(cantilever_hz(along), rel=2e-3)  # a taper has a section for each link
    assert found["frequencies_hz"] == pytest.approx(mujoco_hz(tmp_path / "rod.xml")[:3], rel=1e-9)
    if case == "two halves":  # series stiffness is missing at the step: right joints at the wall alone are worse
        assert found["exact_hz"] == pytest.approx([0.362192, 2.822364, 10.397130], rel=1e-5)
        assert found["frequencies_hz"][0] == pytest.approx(0.345812, rel=1e-5)
        assert not (tmp_path / "out.xml").exists()
        return
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out.xml"))
    kept = [j for j in range(N) if j > 2 or f"y{j}" in odd]
    assert np.reshape(model.jnt_stiffness, (N, -1))[kept, 0] == pytest.approx(np.array(stiffnesses)[kept], rel=1e-9)
    if not odd:
        assert mujoco_hz(tmp_path / "out.xml")[:3] == pytest.approx(cantilever_hz(along), rel=8e-3)


def test_stiffnesses_of_no_law_need_a_scene(tmp_path):
    path = tmp_path / "rod.xml"
    path.write_text(rod((K * np.random.default_rng(3).uniform(0.5, 2.0, N)).tolist()))
    with pytest.raises(InputError, match="give the beam that they mean as a scene"):
        judge_file(path, None)
    beam = Beam(length=0.5, bending_stiffness=EI, mass_per_length=MASS, supports=("clamped", "free"))
    assert len(judge_file(path, beam).data["chains"][0]["odd"]) == 0  # a scene explains all joints: they are set


WHIP = '<geom type="sphere" pos=".072 0 0" size="0.02" mass="0.012" contype="0" conaffinity="0"/>'
LONG = rod([3141.59] * 4, (0.5, 0.1, 0.1, 0.1), 0.358142)
FILES = {
    "long first link": LONG,
    "wall": rod([K] * N),
    "soft": rod([0.1 * K] + [K] * 19),
    "point masses": chain_text(25, '<joint axis="0 1 0" stiffness="0.242"/>', WHIP, ".072 0 0"),
}


@pytest.mark.parametrize("name", FILES)
def test_no_corrected_file_is_worse_at_any_mode(name, tmp_path):
    path, out = tmp_path / "in.xml", tmp_path / "out.xml"
    path.write_text(FILES[name])
    result = judge_file(path, None, 4, corrected=out)
    exact = result.data["chains"][0]["exact_hz"]
    assert out.exists() == ("is not written" not in " ".join(result.warnings))
    assert not (name == "long first link" and out.exists())
    if out.exists():
        before, after = (abs(mujoco_hz(one)[: len(exact)] / exact - 1) for one in (path, out))
        assert all(after <= np.maximum(before, 1e-3))


SPACE = mjcf(describe(STRIP, 20, in_space=True))  # of which torsion has 0.64 % at mode 3
PLANE = re.sub('<joint name="[^"]*(width|torsion)".*?/>', "", SPACE)
BALL = re.sub('<joint name="([^"]*)_bending" type="hinge" axis="[^"]*"', r'<joint name="\1" type="ball"', PLANE)
AXES = {
    "right": (SPACE, True),
    "right in its plane": (PLANE, True),
    "one axis": (PLANE.replace("0 -1 0", "0 0 1"), False),
    "both": (SPACE.replace("0 0 1", "0 1 0").replace("0 -1 0", "0 0 1"), False),
    "ball": (BALL, False),
}


@pytest.mark.parametrize("scene", [STRIP, None], ids=["scene", "file"])
@pytest.mark.parametrize("name", AXES)
def test_stiffness_section_and_inertia_lie_the_same_way(name, scene, tmp_path):
    text, right = AXES[name]
    (tmp_path / "in.xml").write_text(text)
    result = judge_file(tmp_path / "in.xml", scene, 3, corrected=tmp_path / "out.xml")
    chains = {one["axis"]: one for one in result.data["chains"]}
    if name == "one axis" and scene is None:
        assert list(chains) == ["width"]  # any stiffness is a strip's that bends in its width
        return
    assert result.data["passed"] == right == (tmp_path / "out.xml").exists()
    assert any(margin.harm == "premise" for margin in result.margins) != right
    if scene:
        thin, wide = (one / (2 * np.pi) * 1.8751041**2 / 0.7**2 * np.sqrt(206e9 / 7850 / 12) for one in (0.003, 0.025))
        for axis, one in ((axis, one) for axis, one in chains.items() if axis != "torsion"):
            assert one["exact_hz"][0] == pytest.approx(wide if axis == "width" else thin, rel=1e-3)


def test_dummy_links_have_no_radius(tmp_path):
    """The modulus of round links counts those that are round."""
    tube = Beam(
        length=0.5, shape="round", diameter=0.012, youngs_modulus=12.58e6, density=1100.0, supports=("clamped", "free")
    )
    path = tmp_path / "hose.urdf"
    write(describe(tube, 10, in_space=True), path)
    text = re.sub(r'<box size="(\S+)[^"]*"/>', r'<cylinder radius="0.006" length="\1"/>', path.read_text())
    path.write_text(re.sub(r'(<link name="link\d+_.*?)<cylinder[^>]*/>', r'\1<sphere radius="0.002"/>', text))
    assert any("E = 0.01258 GPa" in text for text in judge_file(path, None).warnings)


def test_universal_joints_of_sdf_are_two_hinges(tmp_path):
    chain, path, out = describe(STRIP, 14, wall="full", in_space=True), tmp_path / "in.sdf", tmp_path / "out.sdf"
    text, at, spring = "", "world", "<dynamics><spring_stiffness>{}</spring_stiffness></dynamics>"
    for i, (joint, link) in enumerate(zip(chain.joints, chain.links, strict=False)):
        about = zip(("axis", "axis2"), ("0 -1 0", "0 0 1"), joint.hinges, strict=False)
        axes = "".join(f"<{tag}><xyz>{xyz}</xyz>{spring.format(one.stiffness)}</{tag}>" for tag, xyz, one in about)
        inertia = "".join(f"<i{d}{d}>{one!r}</i{d}{d}>" for d, one in zip("xyz", link.inertia, strict=True))
        text += f'<link name="l{i}"><pose>{link.start} 0 0 0 0 0</pose><inertial><pose>{link.centre} 0 0 0 0 0</pose>'
        text += f'<mass>{link.mass!r}</mass><inertia>{inertia}</inertia></inertial></link><joint name="j{i}" '
        text += f'type="universal"><parent>{at}</parent><child>l{i}</child>{axes}</joint>'
        at = f"l{i}"
    path.write_text(f'<sdf version="1.6"><model name="m">{text}</model></sdf>')
    best = describe(STRIP, 14, in_space=True)
    for file, right, written in ((path, chain, out), (out, best, None)):
        for one in judge_file(file, STRIP, corrected=written).data["chains"]:
            assert one["frequencies_hz"] == pytest.approx(right.frequencies_hz(one["axis"], 5), rel=1e-9)


SMALL = replace(STEEL, length=0.1, width=0.004, thickness=0.001)


@pytest.mark.parametrize(("beam", "rel"), [(STEEL, 1e-9), (SMALL, 2e-5)])
def test_urdf_in_space_loads_in_mujoco_and_sdf_in_parsers_of_1_4_to_1_6(beam, rel, tmp_path):
    chain, path = describe(beam, 20, in_space=True), tmp_path / "beam.urdf"
    write(chain, path)
    own = np.sort(np.concatenate([chain.frequencies_hz(axis) for axis in chain.axes]))[:7]
    assert mujoco_hz(path, springs_beside(path))[:7] == pytest.approx(own, rel=rel)
    write(chain, tmp_path / "beam.sdf")
    text = (tmp_path / "beam.sdf").read_text()
    assert 'version="1.6"' in text
    assert not re.search("relative_to|attached_to|expressed_in|<frame", text)  # of 1.7 on


def test_few_modes_of_a_long_chain_are_those_of_all():
    chain = describe(STEEL, 300, in_space=True)
    for axis in chain.axes:
        assert chain.frequencies_hz(axis, 4) == pytest.approx(chain.frequencies_hz(axis)[:4], rel=1e-10)


FAULTS = r"""
sdf # (?s)\A.*\Z # <sdf/> # no joints
xml # (?s)\A.*\Z # <mujoco/> # no joints
xml # stiffness=" # stiffness="- # joint0_bending
xml # stiffness="[^"]* # stiffness="nan # joint0_bending
xml # stiffness="[^"]* # stiffness="inf # joint0_bending
xml # axis="[^"]* # axis="0 1 # axis
xml # <body # <body><composite type="cable"/></body><body # composite
xml # <worldbody # <extension><plugin plugin="mujoco.elasticity.cable"/></extension><worldbody # EI/l
sdf # <iyy>[^<]* # <iyy>nan # link0
sdf # <mass>[^<]* # <mass>-1 # link0
sdf # <link name="link3" # <link # link 4
sdf # <spring_stiffness> # <spring_stiffness>- # joint0_bending
sdf # <spring_stiffness>[^<]* # <spring_stiffness>nan # joint0_bending
sdf # <child>link3 # <child>lnk3 # lnk3
sdf # <xyz>[^<]* # <xyz>0 1 # joint0_bending
sdf # <xyz>[^<]* # <xyz>0 0 0 # joint0_bending
sdf # <pose>[^<]* # <pose>0 0 0 1 # link0
sdf # <link name="link2"><pose # <link name="link2"><pose relative_to="link2" # link2
sdf # <link name="link2"><pose # <link name="link2"><pose relative_to="lnk" # lnk
sdf # <parent>world # <parent>link9 # link0
sdf # <dynamics> # <dynamics><friction>1</friction> # friction
sdf # <lower>[^<]* # <lower>0 # limit
urdf # <dynamics # <dynamics friction="1" # friction
urdf # limit lower="[^"]* # limit lower="0.1 # limit
urdf # <child link="link3"/> # # joint3_bending
urdf # ixx=" # ixx="- # link0
urdf # <child link="link3"/> # <child link="link2"/> # two joints
"""
"""File, what is replaced, by what, what the sentence names."""


@pytest.mark.parametrize("fault", FAULTS.strip().splitlines())
def test_typing_errors_are_one_sentence_with_the_element(fault, tmp_path, capsys):
    kind, old, new, named = (word.strip() for word in fault.split(" #"))
    path = tmp_path / f"beam.{kind}"
    write(describe(STEEL, 14), path)
    text = path.read_text()
    path.write_text(re.sub(old, new, text, count=1))
    assert path.read_text() != text
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert status_of(["compare", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert named in said.replace(str(path), "")
