"""Every quantity: a finite value on one scene, bad input refused, and no argument without effect."""

import pickle
from typing import Any

import numpy as np
import pytest
from msgspec.structs import asdict, replace

from verify.actuators.patch import Patch
from verify.actuators.transducers import Stack
from verify.analysis.comparison import mode_errors
from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.analytic_modes import ExactModel
from verify.chain.slider_on_chain import slide_on_chain
from verify.dynamics.arguments import Excitation, Keep, Step
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.estimate import Estimate, as_plain, as_text
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass
from verify.problem.slider import Contact, Slider
from verify.quantities import QUANTITIES, evaluate, parse_arguments
from verify.scene.model import Drive, MovingBase, Scene, SceneDevice, SceneForce
from verify.segment_model import SegmentModel
from verify.studies.identify import Identify, Synthetic
from verify.studies.motion import Motion
from verify.travelling_wave import measure

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
DAMPED = replace(STRIP, loss_factor=0.021)
BODY = PointMass(position=0.213, mass=0.047, rotary_inertia=3.1e-5)
LOADED = replace(STRIP, supports=("clamped", "free"), tension=7.1, mass=(BODY,))
ELASTIC = replace(LOADED, supports=("clamped", "pinned"), loss_factor=0.021)
RIDER = Slider(mass=3e-6, mu=0.23, slope=310.0, position=0.271, speed=0.004, preload=0.003)
LIGHT = Slider(mass=1e-6, mu=0.003, slope=2100.0, position=0.271, speed=3e-4, preload=0.003)
HEAVY = replace(RIDER, mass=0.02, coupling="two-way")
TOUCHING = Contact(stiffness=6.1e4, damping=13.0)
POINT = replace(RIDER, mass=0.003, law="coulomb", slope=None, speed=-1.3e-4, preload=0.31, contact=TOUCHING)
TRANSDUCER = Stack(layers=7, layer_thickness=4e-4, area=2.3e-5, dielectric_loss=0.004)
ENDED = Device(position=0.647, stiffness=910.0, mass=0.0071, dashpot=1.3)
FORCES = (PointForce(position=0.0411, amplitude=1.3, phase_deg=17.0), PointForce(position=0.6727, phase_deg=101.0))
DECAY = Identify(what="friction-decay", parameters=("mu", "slope"), synthetic=Synthetic(noise=2e-5, span=(0.0, 4e-5)))
AT_ONCE = {"start": "rest", "soft_start_periods": 0.0, "modal_damping": None, "steps_per_period": 40}


def scene_of(beam, slider=None, duration=None, devices=(), **drive):
    forces, on_it = (SceneForce(**asdict(force)) for force in FORCES), (SceneDevice(**asdict(one)) for one in devices)
    drive.setdefault("kind", "voltage" if "actuator" in drive else "force")
    drive = Drive(frequency_hz=731.0, force=tuple(forces), device=tuple(on_it), **drive)
    studies = {"motion": Motion(duration=duration, **AT_ONCE)} if duration else {}
    return Scene(name="case", beam=beam, drive=drive, slider=slider, studies=studies)


BARE = Scene(name="bare", beam=STRIP)
STACK = Stack(layers=7, layer_thickness=3.1e-4, area=2.3e-7, mechanical_loss=0.01)
SCENES = {
    "bare": BARE,
    "clamped": scene_of(replace(STRIP, supports=("clamped", "pinned"))),
    "loaded": scene_of(LOADED),
    "driven": scene_of(DAMPED, RIDER, 1.1e-3),
    "heavy": scene_of(DAMPED, HEAVY, 1.1e-3),
    "elastic": scene_of(ELASTIC),
    "undamped": scene_of(STRIP, LIGHT, 7e-4),
    "motor": scene_of(DAMPED, replace(POINT, coupling="one-way")),
    "fast": scene_of(DAMPED, replace(POINT, coupling="one-way", mass=0.05, speed=-0.3)),
    "device": scene_of(DAMPED, devices=(ENDED,)),
    "stacks": scene_of(DAMPED, actuator=STACK, kind="voltage"),
    "stack": scene_of(STRIP, actuator=TRANSDUCER),
    "actuated": scene_of(STRIP, actuator=Stack(layers=20, layer_thickness=5e-4, area=25e-6)),
    "patched": scene_of(STRIP, actuator=Patch(length=0.02, thickness=2e-4)),
    "turned": Scene(
        name="turned",
        beam=replace(STRIP, supports=("clamped", "free")),
        base=MovingBase(duration=0.11, rotation=(0.0, 0.0, 3.1), hub_radius=0.07),
    ),
    "decay": Scene(name="decay", beam=STRIP, slider=RIDER, studies={"identify": DECAY}),
}
SEGMENT, FEM = {"model": "segment", "count": 9}, {"model": "fem", "count": 9}
TIME, HELD = {"count": 12}, {"count": 12, "steps_per_period": 23}
LAYER = {"contact_half_angle": 1.1, "speed_ratio": 0.71}
# fmt: off
CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "mode.frequency": ("loaded", {**SEGMENT, "mode": 3, "joints": "tensioned"}),
    "mode.frequency_error": ("loaded", {**FEM, "mode": 3}), "mode.plate_error": ("bare", {"mode": 5}),
    "mode.shape_error": ("clamped", {**SEGMENT, "mode": 2, "reading": "raw"}),
    **{f"mode.{name}": ("clamped", {**SEGMENT, "mode": 2}) for name in ("law_ratio", "curvature_error")},
    "mode.node_position": ("loaded", {**FEM, "mode": 4, "node": 2}),
    "mode.order": ("clamped", {"model": "segment", "mode": 5, "counts": [12, 16, 24], "wall": "half"}),
    "mode.shape_order": ("clamped", {"model": "segment", "mode": 2, "counts": [8, 16, 32], "reading": "raw"}),
    "mode.bracket": ("clamped", {"mode": 3, "count": 9, "wall": "half"}),
    "mode.count_needed": ("clamped", {"model": "segment", "mode": 3, "error": 4e-3, "wall": "half"}),
    "mode.stock_difference": ("clamped", {"mode": 3, "count": 17}), "drive.rule_frequency": ("bare", {"mode": 5}),
    "drive.quarter_wavelength": ("driven", {}), "beam.buckling_load": ("loaded", {**SEGMENT}),
    "wave.deflection": ("device", {**FEM, "x": 0.31}), "slider.coupling_size": ("driven", {"of": "friction"}),
    **{f"wave.{name}": ("device", {}) for name in ("standing_wave_ratio", "reflection", "energy_flux", "crest_speed")},
    "wave.travelling_index": ("driven", {**SEGMENT, "count": 30}),
    "wave.signed_area_spread": ("driven", {"window": [0.2, 0.5]}), "wave.axis_ratio": ("driven", {"x": 0.31}),
    **{f"wave.{name}": ("driven", {"window": [0.2, 0.5]}) for name in ("best_ratio", "best_ratio_phase")},
    "wave.power_imbalance": ("driven", {}), "wave.best_frequency": ("driven", {"span": 0.1}),
    "wave.frequency_band": ("driven", {"span": 0.1, "limit": 9.0}),
    **{f"wave.{name}": ("stacks", {}) for name in ("voltage_ratio", "voltage_direction", "pure_voltage_phase")},
    **{f"drive.{name}": ("stacks", {"actuator": 2}) for name in ("power", "current")},
    "drive.force_per_volt": ("stacks", {}),
    "drive.moment_per_volt": ("patched", {}),
    "drive.impedance_ratio": ("stacks", {}), "wave.best_ratio": ("driven", {}), "wave.best_ratio_phase": ("driven", {}),
    "wave.order": ("driven", {"model": "fem", "counts": [20, 40, 80]}),
    "wave.lumped_swr": ("bare", {"x": 0.31, "modes": [5, 6]}),
    "wave.fastest_crests": ("driven", {"limit": 0.7}), "wave.absorber_impedance": ("driven", {"position": 0.083}),
    "wave.absorber_reflection": ("driven", {"position": 0.083, "resistance": 1.3, "stiffness": 910.0}),
    **{f"slider.{name}": ("driven", TIME) for name in ("displacement", "mean_speed", "largest_friction", "reversal")},
    **{f"slider.{name}": ("driven", TIME) for name in ("mean_friction", "mean_surface_speed", "imbalance")},
    "slider.order": ("driven", {"count": 12, "steps": [2e-5, 1e-5, 5e-6]}),
    "slider.deflection": ("driven", {**TIME, "x": 0.31}), "slider.energy": ("driven", {**TIME, "of": "friction_loss"}),
    "motion.reflection": ("driven", {**TIME, "time": 4e-3, "window": [0.2, 0.5], "start": "steady"}),
    **{f"motor.{name}": ("motor", HELD) for name in ("stall_force", "normal_mean", "contact_fraction", "stick_fraction")},
    "motor.multiplier": ("motor", HELD),
    **{f"motor.{name}": ("motor", {**HELD, "speed": -3e-4}) for name in ("force_speed", "power", "friction_power")},
    "motor.efficiency": ("motor", {**HELD, "speed": -3e-4}), "motor.no_load_speed": ("motor", HELD),
    "motor.free_speed": ("motor", {**HELD, "periods": 400}), "motor.start_time": ("fast", {**HELD, "periods": 400}),
    "motor.contact_imbalance": ("motor", {**HELD, "periods": 60}),
    **{f"control.{n}": ("driven", {**FEM, "target": 6e-7, "speed": 4e-7, "duration": 0.9}) for n in (
        "overshoot", "settling_time")},
    "study.value": ("decay", {"study": "identify", "row": "mu", "column": "sd"}),
    "engine.step_limit": ("clamped", {"count": 9}),
    **{f"engine.{name}": ("clamped", {"count": 9, "mode": 2, "step": 2e-4}) for name in ("frequency", "damping")},
    "chain.contact_line_error": ("clamped", {"segments": 9, "mode": 2, "x": 0.31}),
    "chain.transient_deflection": ("undamped", {"segments": 5, "time": 7e-4, "x": 0.31}),
    "chain.axial_departure": ("undamped", {"segments": 5, "force": 30.0, "time": 7e-4}),
    **{f"chain.slider_{n}": ("undamped", {"segments": 5, "coupling": "one-way"}) for n in ("displacement", "mean_speed", "imbalance")},
    "slider.winkler_speed_ratio": ("bare", {"contact_half_angle": 1.1}), "slider.layer_efficiency": ("bare", LAYER),
    "slider.layer_force": ("bare", {**LAYER, "epsilon": 0.3}),
    **{f"actuator.{name}": ("stack", {}) for name in ("resonance", "antiresonance", "coupling", "branch")},
    "actuator.impedance": ("stack", {"frequency_hz": 7e4}),
    "identify.interval": ("decay", {"parameter": "slope"}),
    "identify.coverage": ("decay", {"parameter": "mu", "repeats": 100}),
    **{f"blade.{n}": ("turned", {"count": 5}) for n in ("lag", "lead", "tip_x", "tip_y", "root_moment", "extension")},
    **{f"blade.{name}": ("turned", {**SEGMENT, "mode": 2}) for name in ("lead_lag", "flap")},
    "case.value": ("bare", {"case": "landing"}), "case.error": ("bare", {"case": "elastica-shortening", "count": 9}),
    "case.order": ("bare", {"case": "elastica-deflection", "counts": [8, 16, 32]}),
    "contact.restitution": ("bare", {"damping_ratio": 0.2}),
    **{f"shunt.{n}": ("bare", {"coupling": 0.17, "circuit": "parallel"}) for n in ("peak", "optimum")},
    **{f"shunt.{n}": ("actuated", {"position": 0.083}) for n in ("absorber", "reflection")},
}
# fmt: on
CACHES = {name: SolutionCache(scene.beam) for name, scene in SCENES.items()}


def figure(name, remove="", **changed):
    where, arguments = CASES[name]
    given = {key: value for key, value in {**arguments, **changed}.items() if key != remove}
    return evaluate(name, given, SCENES[where], CACHES[where])


@pytest.mark.parametrize("name", QUANTITIES)
def test_value_is_finite(name):
    value = figure(name)
    kind = (
        Bracket if name in ("mode.bracket", "wave.frequency_band") else complex if isinstance(value, complex) else float
    )
    assert isinstance(value, kind | int)
    assert np.isfinite([value.lower, value.upper] if isinstance(value, Bracket) else [value]).all()
    assert as_text(value)
    assert as_plain(value) is not None


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (-26.681102, 0.0019, "-26.681 ± 0.002"),
        (21.767, 6.53, "22 ± 7"),
        (1234.56, 32.0, "1230 ± 30"),
        (0.0400021, 4.7e-5, "0.04000 ± 5e-05"),
        (0.00996, 0.00096, "0.010 ± 0.001"),
        (3.1234e-9, 2e-11, "3.12e-09 ± 2e-11"),
        (1e-9, 2e-6, "0 ± 2e-06"),
    ],
)
def test_an_estimate_is_a_number_shown_to_the_digits_that_hold(value, error, shown):
    estimate = pickle.loads(pickle.dumps(Estimate(value, error)))
    assert (estimate, estimate.error) == (value, error)
    assert as_text(estimate) == shown
    assert type(as_plain(estimate)) is float


@pytest.mark.parametrize("name", QUANTITIES)
def test_bad_value_is_refused(name):
    bad = {"whole number": 0.5, "number": float("nan"), "true or false": "perhaps"}
    for argument in QUANTITIES[name].arguments:
        assert argument["description"]
        with pytest.raises(InputError, match=argument["name"]):
            figure(name, **{argument["name"]: bad.get(argument["type"], "nonsense")})
        if argument["required"]:
            with pytest.raises(InputError, match=f"{argument['name']} is missing"):
                figure(name, remove=argument["name"])
    with pytest.raises(InputError, match="lenght is not a known key"):
        figure(name, lenght=1.0)


OTHERS: dict[str, Any] = {
    "count": 17, "mode": 2, "x": 0.37, "wall": "third-order", "joints": "tensioned", "grading": 1.3,
    "theory": "timoshenko", "attachment": "lever", "reading": "raw", "frequency_hz": 700.0, "phase_deg": 61.0,
    "position": 0.053, "loss_factor": 0.013, "modal_damping": 0.031, "load": "lever", "drive": "displacement",
    "window": [0.21, 0.47], "modes": 7, "time": 8e-4, "start": "steady", "soft_start_periods": 0.7, "force": 2.1,
    "mu": 0.17, "slope": 210.0, "law": "coulomb", "coupling": "one-way", "kinematics": "following",
    "normal": "massless", "slider_position": 0.301, "slider_speed": 0.007, "step": 1.1e-5, "steps_per_period": 31,
    "stiffness": 7e4, "mass": 0.004, "speed": -2e-4, "links": "stretching", "segments": 6, "turning": True,
}  # fmt: skip
EFFECTS = [
    ("mode.frequency", "elastic", {"model": "segment", "count": 14, "mode": 3}),
    ("mode.frequency", "elastic", {"model": "analytic", "mode": 3}),
    ("wave.deflection", "elastic", {"model": "segment", "count": 14, "x": 0.31}),
    ("wave.deflection", "elastic", {"model": "analytic", "x": 0.31}),
    ("wave.axis_ratio", "driven", {"model": "fem", "count": 14}),
    ("wave.absorber_reflection", "device", {"position": 0.04, "resistance": 1.3, "model": "analytic"}),
    ("slider.displacement", "heavy", {"count": 14}),
    ("chain.slider_displacement", "undamped", {"segments": 5, "coupling": "one-way", "normal": "massless"}),
    ("motor.force_speed", "motor", {**HELD, "speed": -3e-4}),
]


@pytest.mark.parametrize(("name", "where", "arguments"), EFFECTS)
def test_argument_changes_value_or_is_refused(name, where, arguments):
    scene, cache = SCENES[where], SolutionCache(SCENES[where].beam)
    value = evaluate(name, arguments, scene, cache)
    for argument in QUANTITIES[name].schema.__struct_fields__:
        if argument in OTHERS and arguments.get(argument) != OTHERS[argument]:
            try:
                assert evaluate(name, {**arguments, argument: OTHERS[argument]}, scene, cache) != value, argument
            except InputError as refused:
                assert argument in str(refused)


def test_equals_direct_call():
    exact = ExactModel(STRIP).frequency_hz(3)
    assert evaluate("mode.frequency", {"model": "analytic", "mode": 3}, SCENES["bare"], CACHES["bare"]) == exact
    fem = float(HermiteModel(STRIP, 9).modes(3).frequencies_hz[2])
    asked = {**FEM, "mode": np.int64(3)}
    assert evaluate("mode.frequency_error", asked, SCENES["bare"], CACHES["bare"]) == (fem - exact) / exact
    paired = mode_errors(SegmentModel(STRIP, 12).modes(5), ExactModel(STRIP).modes(4))
    for name, errors in {"frequency": paired.frequency, "shape": paired.shape(), "curvature": paired.curvature}.items():
        value = evaluate(f"mode.{name}_error", {"model": "segment", "count": 12, "mode": 3}, BARE, CACHES["bare"])
        assert errors[2] == pytest.approx(value, rel=1e-9)
    settings = {"model": "segment", "count": 12, "slider": RIDER, "step": Step(per_period=40), "keep": Keep(samples=2)}
    run = simulate(DAMPED, Excitation(FORCES, 731.0), 1.1e-3, **settings)
    assert figure("slider.displacement") == run.displacement
    assert figure("slider.energy") == pytest.approx(run.energy.friction_loss, rel=1e-12)
    wave = measure(ExactModel(DAMPED).harmonic(FORCES, 731.0), (0.2, 0.5))
    assert figure("wave.signed_area_spread") == pytest.approx(wave.signed_area_spread, rel=1e-9)


def test_quantities_of_a_slider_that_may_leave_the_beam_are_those_of_its_run():
    scene, cache, time = SCENES["motor"], CACHES["motor"], {"time": 3.1e-3, "soft_start_periods": 0.7}
    settings = {"model": "fem", "count": 13, "start": "rest", "keep": Keep(samples=2)}
    grown = Excitation(FORCES, 731.0, soft_start_periods=0.7)
    run = simulate(DAMPED, grown, 3.1e-3, slider=scene.slider, **settings)
    arguments = {"model": "fem", "count": 13, **time}
    for name in ("displacement", "mean_speed", "largest_friction", "mean_friction", "mean_surface_speed"):
        assert evaluate(f"slider.{name}", arguments, scene, cache) == getattr(run, name)
    assert evaluate("slider.energy", {**arguments, "of": "slider"}, scene, cache) == run.energy.slider
    changed = simulate(DAMPED, grown, 3.1e-3, slider=replace(scene.slider, mu=0.31), **settings)
    assert evaluate("slider.displacement", {**arguments, "mu": 0.31}, scene, cache) == changed.displacement


def test_a_slider_that_may_leave_the_nonlinear_chain_moves_as_by_a_direct_call():
    scene = replace(SCENES["undamped"], slider=replace(POINT, coupling="one-way"))
    settings = {"count": 6, "step": Step(per_period=40), "keep": Keep(samples=2)}
    run = slide_on_chain(STRIP, Excitation(FORCES, 731.0), 7e-4, slider=scene.slider, **settings)
    value = evaluate("chain.slider_displacement", {"segments": 6}, scene, SolutionCache(STRIP))
    assert value == run.displacement != 0.0


def test_words_are_read_by_type():
    words = ["model=fem", "mode=3", "counts=20, 40-80:20", "grading=1.3"]
    expected = {"model": "fem", "mode": 3, "counts": [20, 40, 60, 80], "grading": 1.3}
    assert parse_arguments("mode.order", words) == expected
    needed = parse_arguments("mode.count_needed", ["model=fem", "mode=3", "error=0.7%"])
    assert needed["error"] == pytest.approx(0.007, rel=1e-15)
    with pytest.raises(InputError, match=r"did you mean 'mode\.frequency'"):
        parse_arguments("mode.freqency", [])
    wrong = {"mode": "KEY=VALUE", "mod=3": "did you mean 'mode'", "mode=3 mode=4": "repeats", "counts=80-20": "upwards"}
    for text, sentence in wrong.items():
        with pytest.raises(InputError, match=sentence):
            parse_arguments("mode.order", text.split())


@pytest.mark.parametrize(
    ("name", "where", "changed", "sentence"),
    [
        ("wave.reflection", "bare", {}, "drive.force is missing: add"),
        ("slider.displacement", "bare", {}, "time is missing and the scene has no"),
        ("motor.stall_force", "driven", {}, "slider.contact is missing: add"),
        ("motor.stall_force", "motor", {**HELD, "theory": "rayleigh"}, "a motor has Euler-Bernoulli theory alone"),
        ("chain.transient_deflection", "bare", {}, "drive.force is missing: add"),
        ("case.error", "bare", {"case": "elastica"}, "case = 'elastica' is not known"),
        ("case.error", "bare", {"case": "roll-up-gregory", "count": 7}, "count = 7: the size of case .* is fixed"),
        ("drive.quarter_wavelength", "bare", {}, "frequency_hz is missing"),
        ("slider.displacement", "motor", {"kinematics": "following", "time": 1e-3}, "slider.kinematics = 'following'"),
        ("mode.frequency", "device", {"count": 14}, "does not model drive.device"),
        ("wave.deflection", "driven", {"x": 0.74}, "x = 0.74 lies off the beam"),
        ("slider.order", "driven", {"counts": [8, 16, 32]}, "counts = .* and steps = .*: give one"),
    ],
)
def test_refused_with_field_and_remedy(name, where, changed, sentence):
    with pytest.raises(InputError, match=sentence):
        evaluate(name, {**CASES[name][1], **changed}, SCENES[where], CACHES[where])
