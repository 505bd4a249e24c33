"""Bad input to scenes, beams, sliders and the public verbs: one sentence with field, value and remedy."""

from math import inf, nan

import numpy as np
import pytest

from verify import (
    Beam,
    Contact,
    ExactModel,
    Excitation,
    Foot,
    HermiteModel,
    InputError,
    Keep,
    PointForce,
    PointMass,
    PointSpring,
    PrescribedSlider,
    Section,
    SegmentModel,
    Slider,
    Step,
    bend,
    free_vibration,
    load_scene,
    simulate,
)
from verify.cases.belt import stick_slip_times
from verify.cases.creep import creep_speed
from verify.errors import NAMES, SENTENCE, near_name, one_line, shown

TITANIUM = {"length": 0.73, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}
STRIP = Beam(**TITANIUM, loss_factor=0.01)
CANTILEVER = Beam(**TITANIUM, supports=("clamped", "free"))
FORCE = PointForce(position=0.083, amplitude=1.7, phase_deg=23.0)
HERTZ = 411.0
DRIVE, BODY = Excitation(FORCE, HERTZ), Slider(mass=0.0031, mu=0.17)


def beam(**given):
    return lambda: Beam(**TITANIUM | given)


def slider(**given):
    return lambda: Slider(**{"mass": 0.0031, "mu": 0.17} | given)


def contact(**given):
    return lambda: Contact(**given)


def foot(**given):
    return lambda: Foot(**{"length": 0.02, "points": 5} | given)


def scene(*overrides, name="paper-slider"):
    return lambda: load_scene(name, overrides)


BEAMS = [
    *((beam(**{field: value}), rf"beam\.{field} = .*: give a finite number above 0 \(.+\)")
      for field in TITANIUM for value in (0.0, -1.5, nan, inf, True)),
    (beam(thickness=1e-110), r"beam: its bending stiffness is 0 N m\^2.*check their units"),
    (beam(poissons_ratio=0.6), r"beam\.poissons_ratio = 0\.6: give a finite number"),
    (beam(loss_factor=-0.01), r"beam\.loss_factor = -0\.01"),
    (beam(tension=inf), r"beam\.tension = inf"),
    (beam(foundation=-1.0), r"beam\.foundation = -1\.0"),
    (beam(supports=("pinned",)), r"beam\.supports = \('pinned',\): give a list of length 2"),
    (beam(supports=("pinned", "clampd")), r"beam\.supports\[1\] = 'clampd' is not known: did you mean 'clamped'"),
    (beam(shape="tube"), r"beam\.width = 0\.031 does not belong to a tube: leave it out"),
    (beam(shape="squar"), r"beam\.shape = 'squar' is not known"),
    (beam(bending_stiffness=3.0), r"beam\.bending_stiffness = 3\.0 contradicts the shape .* one of the two"),
    (lambda: Beam(length=0.73, width=0.031), r"beam\.thickness is missing: a rectangle needs"),
    (lambda: Beam(length=0.5, shape="tube", diameter=0.02, wall_thickness=0.011, youngs_modulus=7e10, density=2700.0),
     r"beam\.wall_thickness = 0\.011: give a finite number above 0 and below 0\.01"),
    (beam(section=(Section(length=0.3), Section(length=0.4))), r"lengths add up to 0\.7 m .*: make them equal"),
    (beam(section=(Section(length=0.73 - 1e-9), Section(length=1e-9))), r"beam\.section\[1\]\.length = 1e-09 m is less than"),
    (beam(section=[0.4, 0.33]), r"beam\.section\[0\] = 0\.4: give a table, a Section in Python"),
    (beam(mass=[PointMass(position=0.8, mass=0.1)]), r"beam\.mass\[0\]\.position = 0\.8 lies off the beam"),
    (beam(mass=[PointMass(position=0.0, mass=0.1)]), r"beam\.mass\[0\]\.position = 0\.0 m is on a pinned support"),
    (lambda: PointMass(position=0.1), r"beam\.mass at position = 0\.1"),
    (lambda: PointMass(position=-0.1, mass=1.0), r"beam\.mass\.position = -0\.1"),
    (lambda: PointSpring(position=0.1), r"beam\.spring at position = 0\.1 has no effect: give one of stiffness, rotational"),
    (lambda: PointSpring(position=0.1, stiffness=-3.0), r"beam\.spring\.stiffness = -3\.0"),
    (lambda: PointForce(position=-0.1), r"force\.position = -0\.1: give a finite number of at least 0"),
    (lambda: PointForce(position=0.1, amplitude=nan), r"force\.amplitude = nan"),
]  # fmt: skip
SLIDERS = [
    (slider(mass=0.0), r"slider\.mass = 0\.0: give a finite number above 0"),
    (slider(mu=-0.2), r"slider\.mu = -0\.2"),
    (slider(law="viscous"), r"slider\.law = 'viscous' is not known: known are tanh, coulomb"),
    (slider(law="coulomb", slope=100.0), r"slider\.slope = 100\.0 is K of Eq\. \(3\).* leave it out"),
    (slider(mu_static=0.3), r"slider\.mu_static = 0\.3 is for law = 'coulomb'"),
    (slider(law="coulomb", mu_static=0.1), r"slider\.mu_static = 0\.1: give a finite number of at least 0\.17"),
    (slider(gravity=0.0), r"slider\.gravity = 0\.0 without slider\.preload: the normal force is zero"),
    (slider(external_force=0.3), r"slider\.external_force .*: give slider\.contact too"),
    (slider(contact=Contact(), foot=[Foot(length=0.02, points=3)]), r"slider\.foot: hard contact has one point"),
    (slider(contact=Contact(layer_stiffness=1e7)), r"slider\.contact\.layer_stiffness is per metre of foot"),
    (slider(contact=3.0), r"slider\.contact = 3\.0: give a table, a Contact in Python"),
    (contact(stiffness=-1.0), r"slider\.contact\.stiffness = -1\.0"),
    (contact(stiffness=1e5, layer_stiffness=1e6), r"slider\.contact\.stiffness = .* give one"),
    (contact(restitution=1.2), r"slider\.contact\.restitution = 1\.2: give .* of at most 1"),
    (contact(stiffness=1e5, restitution=0.4), r"slider\.contact\.restitution = 0\.4 is for hard contact"),
    (contact(damping=3.0), r"slider\.contact\.damping = 3\.0 .* give slider\.contact\.stiffness too"),
    (foot(points=0), r"slider\.foot\.points = 0: give a whole number of at least 1"),
    (foot(length=0.0), r"slider\.foot\.points = 5 needs a length: give slider\.foot\.length"),
    (foot(pitches="no"), r"slider\.foot\.pitches = 'no': give true or false"),
    (foot(face="uper"), r"slider\.foot\.face = 'uper' is not known: did you mean 'upper'"),
    (foot(mirrored=True, face="lower"), r"slider\.foot\.mirrored = true with face = .lower."),
    (foot(pitches=False, inertia=1e-6), r"slider\.foot\.inertia = 1e-06 with pitches = false"),
]
SCENES = [
    (scene("drive.frequency_hz=1e300"), r"drive\.frequency_hz = 1e\+300 Hz .* check the beam's units"),
    (scene("drive.kind=charge"), r"drive\.kind = 'charge' is not known: known are force, moment, displacement"),
    (scene("drive.kind=voltage"), r"drive\.actuator is missing: drive\.kind = 'voltage' needs the design"),
    (scene("drive.kind=force", name="patch-motor"), r"drive\.kind = 'force': its amplitudes are not those of a"),
    (scene("drive.actuator.length=3", name="patch-motor"), r"patch\.length = 3\.0: give at most the beam's length"),
    (scene("drive.actuator.kind=stak"), r"drive\.actuator\.kind = 'stak' is not known: did you mean 'stack'"),
    (scene("drive.actuator.layers=3"), r"drive\.actuator\.kind is missing: give one of stack, bar-33"),
    (scene("drive.force.0.position=0.6"), r"drive\.force\.position = 0\.6 lies off the beam"),
    (scene("drive.force.0.position=0.0"), r"drive\.force\.position = 0\.0 m is on a pinned support"),
    (scene("slider.position=0.51"), r"slider\.position = 0\.51 lies off the beam"),
    (scene("motion.duration=0"), r"motion\.duration = 0"),
    (scene("motion.start=steady"), r"motion\.soft_start_periods = 2"),
    (scene("motion.samples=1"), r"motion\.samples = 1"),
    (scene("claim.mean-speed.tolerance=0"), r"claim\.mean-speed\.tolerance = 0"),
    (scene("claim.mean-speed.read=guessed"), r"claim\.mean-speed\.read = 'guessed'"),
    (scene("name=../x"), r"name = '\.\./x'"),
    (scene(f"name={'x' * 121}"), r"name = 'x+ \.\.\. x+'|name = 'x+"),
    (scene("gate.slider-reversed.id=slider-on-elements"), r"gate\.slider-on-elements occurs twice"),
    (scene("gate.slider-reversed.reference=hearsay"), r"gate\.slider-reversed\.reference = 'hearsay'"),
    (scene("spectrum.modes=10001", name="paper"), r"spectrum\.modes = 10001: give a whole number of .* at most 10000"),
    (scene("convergence.modes=0", name="paper"), r"convergence\.modes\[0\] = 0"),
    (scene("drive.device.0.position=0.5", name="absorbing-end"), r"device\.position = 0\.0 m is on a pinned support"),
    (scene("drive.kind=displacement", name="absorbing-end"), r"drive\.kind = 'displacement': with a drive\.device"),
]  # fmt: skip
VERBS = [
    (lambda: SegmentModel(STRIP, 1), r"n_segments = 1: give a whole number of at least 2"),
    (lambda: SegmentModel(STRIP, 20, joints=7), r"joints = 7 is not known"),
    (lambda: SegmentModel("strip", 20), r"beam = 'strip': give a Beam"),
    (lambda: SegmentModel(STRIP, 20, joint_dashpot=-1.0), r"joint_dashpot = -1\.0"),
    (lambda: SegmentModel(STRIP, 20, reading="rw"), r"reading = 'rw' is not known"),
    (lambda: HermiteModel(STRIP, 2.5), r"n_elements = 2\.5: give a whole number of at least 1"),
    (lambda: ExactModel(STRIP).modes(True), r"n_modes = True: give a whole number of at least 1"),
    (lambda: ExactModel(STRIP).harmonic(FORCE, []), r"frequenc"),
    (lambda: simulate(STRIP, DRIVE, 0.0, count=9), r"duration = 0\.0"),
    (lambda: simulate(STRIP, DRIVE, 1e-3, count=9, model="segmnt"), r"model = 'segmnt'.* did you mean 'segment'"),
    (lambda: simulate(STRIP, FORCE, 1e-3, count=9), r"excitation = PointForce.*: give an Excitation"),
    (lambda: simulate(STRIP, DRIVE, 1e-3, count=9, slider=3.0), r"slider has 3\.0: give a Slider"),
    (lambda: simulate(STRIP, Excitation([], HERTZ), 1e-3, count=9, slider=[]), r"forces is empty"),
    (lambda: simulate(STRIP, DRIVE, 1e-3, count=9, slider=BODY, step=Step(per_period=3)), r"step\.per_period = 3"),
    (lambda: Excitation(FORCE, 0.0), r"frequency_hz = 0\.0"),
    (lambda: Excitation(STRIP, HERTZ), r"forces has Beam.*: give a PointForce"),
    (lambda: Excitation(FORCE, HERTZ, 2.0, [(1e-3, [0.0, 1.0])]), r"soft_start_periods = 2\.0 and envelope"),
    (lambda: PrescribedSlider(BODY, nan), r"prescribed_slider\.speed = nan"),
    (lambda: PrescribedSlider(BODY, [0.1, 0.2]), r"prescribed_slider\.speed = \(0\.1, 0\.2\): give one number"),
    (lambda: Step(per_period=0), r"step\.per_period = 0"),
    (lambda: Step(seconds=1e-6, per_period=64), r"step\.seconds = 1e-06 and step\.per_period = 64"),
    (lambda: Keep(samples=1), r"keep\.samples = 1"),
    (lambda: Keep(at=["tip"]), r"keep\.at = \['tip'\]"),
    (lambda: free_vibration(STRIP, 2, 0.0, model="fem", count=9), r"duration = 0\.0"),
    (lambda: free_vibration(STRIP, 0, 1e-3, model="fem", count=9), r"shape = 0"),
    (lambda: bend(CANTILEVER, 9, nan), r"load\.force y = nan"),
    (lambda: bend(STRIP, 9, 1.0), r"beam\.supports"),
    *((lambda part=part: creep_speed(0.2, 900.0, part * 1.962), "acceleration = ") for part in (1.0, -1.2, 1 - 1e-8)),
    (lambda: stick_slip_times(0.7, 310.0, 1.7, 1.7, 0.11), "kinetic"),
    (lambda: stick_slip_times(0.7, 310.0, 2.9, 1.7, 1e12), "lower the speed"),
    (lambda: bend(CANTILEVER, 0, 1.0), r"count = 0"),
    (lambda: Beam(**TITANIUM, mass=np.array(3.0)), r"beam\.mass = 3\.0: give a list"),
    (
        lambda: Beam(**TITANIUM | {"length": np.ma.array([0.7], mask=[True])}),
        r"beam\.length = \[None\]: give one number",
    ),
]
CASES = {"beam": BEAMS, "slider": SLIDERS, "scene": SCENES, "verb": VERBS}


@pytest.mark.parametrize(
    ("call", "message"),
    [pytest.param(*case, id=f"{kind}-{i}") for kind, cases in CASES.items() for i, case in enumerate(cases)],
)
def test_bad_input_is_one_sentence(call, message):
    with pytest.raises(InputError, match=message) as caught:
        call()
    for sentence in caught.value.sentences:
        assert "\n" not in sentence
        assert len(sentence) <= SENTENCE
        assert "null" not in sentence
        assert "<class" not in sentence


def test_message_is_one_short_printable_line():
    text = str(InputError(f"beam.{'a' * 9000}\n\x1b[31m: give a number"))
    assert text.startswith("beam.aaa")
    assert text.endswith("\\n\\x1b[31m: give a number")
    assert len(text) <= SENTENCE
    assert one_line("a\tb") == "a\\tb"
    assert shown([10**200, "z" * 500]).startswith("[a whole number of 665 bits, 'zzz")


def test_of_many_names_the_first_are_listed():
    names = [f"name-{n}" for n in range(100, 126)]
    assert near_name("other", names) == f"known are {', '.join(names[:NAMES])} and {26 - NAMES} more"
    assert near_name("Name-120", names) == "did you mean 'name-120'?"
