"""Bad input of a motor gets one sentence that names field, value and remedy, before anything moves."""

import pytest
from msgspec.structs import replace

from verify import Beam, Contact, Foot, InputError, PointForce, Slider, run_motor, run_motors, simulate
from verify.judge.workbench import Workbench
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.scenes.scene import load_scene

BEAM = Beam(length=0.31, width=0.013, thickness=0.0012, youngs_modulus=68e9, density=2650.0, loss_factor=0.01)
FORCES = [PointForce(position=0.021, amplitude=0.4), PointForce(position=0.27, amplitude=0.3, phase_deg=70.0)]
SPRINGS = Contact(stiffness=6e4)


def a_slider(**given):
    own = {"mass": 0.003, "mu": 0.23, "law": "coulomb", "preload": 0.05, "coupling": "one-way", "contact": SPRINGS}
    return Slider(**{**own, **given})


def moved(slider, **given):
    return run_motor(BEAM, FORCES, 3130.0, 6e-4, slider=slider, **{"model": "fem", "count": 17, "samples": 3, **given})


@pytest.mark.parametrize(
    ("make", "field", "remedy"),
    [
        (lambda: Contact(stiffness=-4e4), "slider.contact.stiffness = -40000.0", "above 0"),
        (lambda: Contact(layer_stiffness=0.0), "slider.contact.layer_stiffness = 0.0", "above 0"),
        (lambda: Contact(stiffness=1.0, damping=-0.1), "slider.contact.damping = -0.1", "at least 0"),
        (lambda: Contact(restitution=1.2), "slider.contact.restitution = 1.2", "0 to 1"),
        (lambda: Contact(restitution=-0.2), "slider.contact.restitution = -0.2", "at least 0"),
        (lambda: Contact(stiffness=1.0, restitution=0.4), "slider.contact.restitution = 0.4", "leave one out"),
        (lambda: Contact(damping=0.4), "slider.contact.damping = 0.4", "slider.contact.stiffness"),
        (lambda: Contact(stiffness=1.0, layer_stiffness=2.0), "slider.contact.stiffness = 1.0", "give one"),
        (lambda: Foot(length=-0.1), "slider.foot.length = -0.1", "at least 0"),
        (lambda: Foot(points=3), "slider.foot.points = 3", "slider.foot.length"),
        (lambda: Foot(length=0.1, points=0), "slider.foot.points = 0", "at least 1"),
        (lambda: Foot(inertia=1e-6), "slider.foot.inertia = 1e-06", "leave it out"),
        (
            lambda: Foot(length=0.02, points=5, pitches=False, inertia=1e-6),
            "slider.foot.inertia = 1e-06",
            "leave it out",
        ),
        (lambda: Foot(face="left"), "slider.foot.face = 'left'", "lower"),
        (lambda: Foot(face="lower", mirrored=True), "slider.foot.mirrored = true", "upper"),
        (lambda: a_slider(contact=None, foot=(Foot(),)), "slider.foot", "slider.contact"),
        (lambda: a_slider(contact=None, pull=0.1), "slider.pull", "slider.contact"),
        (lambda: a_slider(preload_stiffness=-1.0), "slider.preload_stiffness = -1.0", "at least 0"),
        (lambda: a_slider(mu_static=0.4), "slider.mu_static = 0.4", "leave it out"),
        (lambda: a_slider(kinematics="following"), "slider.kinematics = 'following'", "leave it out"),
        (lambda: a_slider(contact=Contact(layer_stiffness=1e6)), "slider.contact.layer_stiffness", "foot.length"),
        (
            lambda: a_slider(contact=Contact(stiffness=6e4, layer_tangential_stiffness=3e5)),
            "slider.contact.layer_tangential_stiffness",
            "foot.length",
        ),
        (lambda: a_slider(foot=(Foot(length=0.02),)), "slider.foot.length = 0.02", "slider.foot.points"),
        (lambda: a_slider(contact=Contact(), foot=(Foot(), Foot())), "slider.foot", "slider.contact.stiffness"),
    ],
)
def test_a_contact_that_cannot_be_is_refused_by_field_value_and_remedy(make, field, remedy):
    with pytest.raises(InputError) as refused:
        make()
    assert field in str(refused.value)
    assert remedy in str(refused.value)
    assert len(str(refused.value)) < 260


@pytest.mark.parametrize(
    ("slider", "given", "field", "remedy"),
    [
        ({"foot": (Foot(length=0.5, points=3),)}, {}, "slider.foot.length = 0.5 m is longer", "shorten"),
        ({"foot": (Foot(length=0.1, points=3),), "position": 0.03}, {}, "slider.position = 0.03", "move the slider"),
        ({"position": 0.5}, {}, "slider.position = 0.5", "between 0 and 0.31"),
        ({"preload": 0.0, "foot": (Foot(face="lower"),)}, {}, "slider.preload leaves foot 1 off", "raise"),
        ({"contact": Contact(stiffness=6e7)}, {"step": 3e-5}, "step = 3e-05", "give at most"),
        ({}, {"links": "stretching"}, "links = 'stretching'", "leave it out"),
        ({}, {"held_speed": float("nan")}, "held_speed", "finite"),
        ({"coupling": "auto"}, {"model": "chain", "count": 9}, "slider.coupling = 'auto'", "one-way"),
        ({}, {"model": "chain", "count": 9}, "start = 'steady'", "'rest'"),
        ({}, {"model": "chain", "count": 9, "start": "rest"}, "modal_damping = 0.005", "0.0"),
        ({}, {"model": "chain", "count": 9, "links": "elastic"}, "links = 'elastic'", "rigid"),
        ({}, {"model": "chain", "count": None}, "count is missing", "number of links for model = chain"),
        ({}, {"model": "chain", "count": 9, "modes": 4}, "modes = 4", "leave it out"),
        ({"contact": Contact(), "coupling": "two-way"}, {}, "slider.coupling = 'two-way'", "one-way"),
        ({"contact": Contact(), "foot": (Foot(offset=0.003),)}, {}, "slider.foot.offset = 0.003", "leave it out"),
        (
            {"law": "tanh", "contact": Contact(stiffness=6e4, tangential_stiffness=3e4)},
            {},
            "slider.law = 'tanh' with slider.contact.tangential_stiffness = 30000.0",
            "law = 'coulomb'",
        ),
        ({"contact": Contact(), "preload_stiffness": 3.0}, {}, "slider.preload_stiffness = 3.0", "preload alone"),
        ({"foot": (Foot(mirrored=True),), "coupling": "two-way"}, {}, "slider.gravity = 9.81", "one-way"),
        (
            {"foot": (Foot(mirrored=True), Foot(offset=0.01)), "coupling": "two-way", "gravity": 0.0},
            {},
            "slider.foot: some are mirrored",
            "one-way",
        ),
    ],
)
def test_a_run_that_cannot_be_is_refused_before_it_begins(slider, given, field, remedy):
    with pytest.raises(InputError) as refused:
        moved(a_slider(**slider), **given)
    assert field in str(refused.value)
    assert remedy in str(refused.value)


def test_verbs_of_a_slider_that_never_leaves_refuse_one_that_may():
    from verify.chain.ride import ride_from_rest
    from verify.motion.pure_wave import terminal_speed

    slider = a_slider(law="tanh")
    for verb in (
        lambda: simulate(BEAM, FORCES, 3130.0, 1e-4, slider=slider, model="fem", count=9),
        lambda: ride_from_rest(replace(BEAM, loss_factor=0.0), FORCES, 3130.0, slider, 9, 1e-4, step=1e-5),
        lambda: terminal_speed(BEAM, slider, 1e-7, 3130.0),
    ):
        with pytest.raises(InputError, match=r"slider\.contact .* run_motor"):
            verb()
    with pytest.raises(InputError, match=r"slider\.contact is missing"):
        moved(a_slider(contact=None))
    for amplitude in (0.0, -1e-7):
        with pytest.raises(InputError, match=rf"^amplitude = {amplitude!r}: give a .* above 0"):
            terminal_speed(BEAM, a_slider(law="tanh", contact=None), amplitude, 3130.0)


def test_sliders_on_one_beam_rub_and_are_coupled_alike():
    one = a_slider(position=0.1)
    smooth = a_slider(position=0.1, law="tanh", slope=3.0)
    for first, other, field in (
        (one, {"law": "tanh"}, "law"),
        (one, {"coupling": "two-way"}, "coupling"),
        (smooth, {"law": "tanh", "slope": 2.0}, "slope"),
    ):
        both = [first, a_slider(position=0.2, **other)]
        with pytest.raises(InputError, match=rf"slider\.{field} differs"):
            run_motors(BEAM, FORCES, 3130.0, 1e-4, sliders=both, model="fem", count=9)
    with pytest.raises(InputError, match="sliders is empty"):
        run_motors(BEAM, FORCES, 3130.0, 1e-4, sliders=[], model="fem", count=9)


def test_a_slider_that_runs_off_the_beam_says_so_with_what_it_did_until_then():
    found = moved(a_slider(position=0.3, speed=20.0), samples=50)
    assert found.statistics.stopped == "left the beam"
    assert 0.0 < found.travelled[-1] < 0.011
    assert len(found.times) == len(found.speed) < 50


def test_a_slider_that_is_in_the_air_at_the_end_says_since_when():
    """Thrown up by a wave a hundred times stronger than what presses it on."""
    thrown = run_motor(
        BEAM,
        [replace(one, amplitude=60.0) for one in FORCES],
        3130.0,
        2e-3,
        slider=a_slider(preload=0.0, contact=Contact(stiffness=6e5)),
        model="fem",
        count=17,
        samples=41,
    )
    left = thrown.events[thrown.events[:, 1] == 5.0, 0]
    assert thrown.normal_force[-1] == 0.0 < thrown.height[-1, 0]
    assert thrown.notes[-1] == f"the slider is off the beam at the end, 0.002 s, and has been since {left[-1]:.6g} s"
    assert not any("off the beam" in note for note in moved(a_slider()).notes)


def test_a_beam_that_its_own_compression_buckles_carries_no_motor():
    with pytest.raises(InputError, match=r"beam\.tension"):
        run_motor(replace(BEAM, tension=-1e6), FORCES, 3130.0, 6e-4, slider=a_slider(), model="fem", count=17)


def test_a_foot_whose_springs_all_stand_clear_of_a_wave_has_no_force_over_its_pressure():
    """Drawn by chance: three springs in a wavelength, and a contact of a fiftieth of a degree about the crest."""
    quantity = QUANTITIES["slider.wave_force"]
    narrow = {"contact_half_angle": 0.003, "speed_ratio": 0.83, "points": 3, "frequency_hz": 4276.0}
    scene = load_scene("driving-layer")
    with pytest.raises(InputError, match=r"points = 3: none touches within 0\.003 rad of a crest, give more"):
        evaluate(quantity, arguments_of(quantity, narrow), scene, Workbench(scene.beam))
