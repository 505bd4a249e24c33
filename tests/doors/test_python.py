"""What a user types in Python: what is exported, what verbs take, what `help` tells."""

import inspect
import pydoc
import subprocess
import sys

import numpy as np
import pytest
from msgspec.structs import replace

import verify
from verify import Beam, InputError, PointForce, PointMass, Section, analytic_modes, fem_beam, segment_model
from verify import travelling_wave as wave
from verify.field_docs import Value, fields_of

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0, loss_factor=0.01)
FORCE = PointForce(position=0.083, amplitude=1.7, phase_deg=23.0)
HERTZ = 411.0
COUNTS = {"segment": "segments", "fem": "elements"}
MODELS = {"analytic": (analytic_modes, ()), "segment": (segment_model, (37,)), "fem": (fem_beam, (37,))}


def modes_of(model, n=3, beam=STRIP):
    face, count = MODELS[model]
    return face.solve_modes(beam, n, *count)


def field_of(model, forces=FORCE, hertz=HERTZ):
    face, count = MODELS[model]
    return face.solve_harmonic(STRIP, forces, hertz, *count)


def refused(asked, *said):
    """That it is refused in one sentence with these words."""
    with pytest.raises(InputError) as found:
        asked()
    text = str(found.value)
    assert "\n" not in text
    assert all(word in text for word in said), text


# ------------------------------------------------------------------------------------------------- places and forces


@pytest.mark.parametrize("model", MODELS)
def test_a_number_for_x_is_a_row_of_one_and_a_list_gives_what_its_array_gives(model):
    modes, field, x = modes_of(model), field_of(model), np.array([0.111, 0.3, 0.52])
    face, count = MODELS[model]
    sweep = face.sweep_harmonic(STRIP, FORCE, [300.0, HERTZ], *count)
    reads = [(modes.deflection, (3,)), (modes.slope, (3,)), (field.deflection, ()), (field.slope, ()), (field.turn, ())]
    for read, rows in (*reads, (sweep.deflection, (2,)), (sweep.slope, (2,))):
        values = read(x)
        assert values.shape == (*rows, 3)
        assert np.array_equal(read([0.111, 0.3, 0.52]), values)
        assert np.array_equal(read(tuple(x)), values)
        for number in (0.3, np.float64(0.3), np.array(0.3)):
            assert np.shape(read(number)) == (*rows, 1)
            assert np.array_equal(read(number), values[..., 1:2])
        assert np.array_equal(read(x.reshape(3, 1)), values[..., None])
        assert read([]).shape == (*rows, 0)


@pytest.mark.parametrize("derivative", [-1, 1.5, True, "1", None])
@pytest.mark.parametrize(
    "beam", [STRIP, replace(STRIP, mass=(PointMass(position=0.2, mass=0.1),))], ids=["bare", "mass"]
)
@pytest.mark.parametrize("model", MODELS)
def test_what_is_no_derivative_is_refused_by_every_line_of_every_model(model, beam, derivative):
    """Minus one was a number, one and a half not one, and true a slope."""
    face, count = MODELS[model]
    thick = face.solve_harmonic(beam, FORCE, HERTZ, *count, theory="timoshenko")
    field = face.solve_harmonic(beam, FORCE, HERTZ, *count)
    sweep = face.sweep_harmonic(beam, FORCE, [300.0, HERTZ], *count)
    lines = [face.solve_modes(beam, 3, *count).shapes, face.time_basis(beam, *(count or (9,))).shapes]
    lines += [field.shapes, field.turns, thick.turned, thick.turns, sweep.shapes, sweep.field(0).shapes]
    for line in lines:
        refused(
            lambda line=line: line(np.array([0.1]), derivative), "derivative = ", "give a whole number of at least 0"
        )
        assert np.array_equal(line(np.array([0.1]), np.int64(1)), line(np.array([0.1]), 1))


@pytest.mark.parametrize("model", MODELS)
def test_whole_numbers_are_places_too(model):
    assert np.array_equal(field_of(model).deflection(0), field_of(model).deflection(0.0))


@pytest.mark.parametrize("x", ["0.3", None, [0.1, "0.2"], [[0.1], [0.2, 0.3]], 0.3j, True, {0.1}])
@pytest.mark.parametrize("model", MODELS)
def test_what_is_no_place_is_refused_in_one_sentence(model, x):
    for read in (modes_of(model).deflection, field_of(model).slope):
        refused(lambda read=read: read(x), "x = ", "give a number, a list or an array of numbers (metres)")


@pytest.mark.parametrize("model", MODELS)
def test_a_place_off_the_beam_is_refused_with_the_beams_length(model):
    for x in (-0.1, 0.7301, np.nan, [0.2, 0.8]):
        refused(lambda x=x: modes_of(model).deflection(x), "lies off the beam", "0.73 m")
        refused(lambda x=x: field_of(model).deflection(x), "lies off the beam", "0.73 m")


@pytest.mark.parametrize("model", MODELS)
def test_a_force_alone_is_a_list_of_one(model):
    values = field_of(model, [FORCE]).deflection(0.41)
    assert field_of(model).deflection(0.41) == values
    assert field_of(model, (one for one in [FORCE])).deflection(0.41) == values
    assert field_of(model).forces == (FORCE,)


def test_a_force_alone_may_be_named():
    field = segment_model.solve_harmonic(STRIP, forces=FORCE, frequency_hz=HERTZ, n_segments=37)
    assert field.deflection(0.41) == field_of("segment").deflection(0.41)


@pytest.mark.parametrize("model", ["analytic"])
def test_what_is_no_force_is_refused(model):
    for forces in (0.3, None, [FORCE, 0.3], "here", {"position": 0.1}):
        refused(lambda forces=forces: field_of(model, forces), "forces has ", "give a PointForce")
    refused(lambda: field_of(model, []), "forces is empty")


@pytest.mark.parametrize("model", MODELS)
def test_unit_responses_take_numbers_and_lists_and_keep_three_axes(model):
    face, count = MODELS[model]
    whole = face.unit_responses(STRIP, np.array([0.1, 0.42]), np.array([300.0, 411.0]), np.array([0.2, 0.6]), *count)
    assert whole.shape == (2, 2, 2)
    assert np.array_equal(face.unit_responses(STRIP, [0.1, 0.42], [300, 411], (0.2, 0.6), *count), whole)
    one = face.unit_responses(STRIP, 0.42, 411.0, 0.6, *count)
    assert one.shape == (1, 1, 1)
    assert one[0, 0, 0] == pytest.approx(whole[1, 1, 1], rel=1e-12)


@pytest.mark.parametrize(
    "beam", [STRIP, replace(STRIP, mass=(PointMass(position=0.2, mass=0.1),))], ids=["bare", "mass"]
)
@pytest.mark.parametrize("model", MODELS)
def test_unit_responses_to_nothing_are_empty_along_their_axis(model, beam):
    face, count = MODELS[model]
    given = {"positions": [0.1, 0.42], "frequencies_hz": [300.0, 411.0, 500.0], "x": [0.2, 0.3, 0.5, 0.6]}
    for axis, name in enumerate(("frequencies_hz", "positions", "x")):
        shape = [3, 2, 4]
        shape[axis] = 0
        found = face.unit_responses(beam, **(given | {name: []}), **({f"n_{COUNTS[model]}": count[0]} if count else {}))
        assert found.shape == tuple(shape)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"positions": [[0.1, 0.42]]}, "positions has the shape (1, 2)"),
        ({"x": [[0.2], [0.6]]}, "x has the shape (2, 1)"),
        ({"frequencies_hz": [[300.0, 411.0]]}, "frequencies_hz has the shape (1, 2)"),
        ({"positions": [0.1, 0.7301]}, "positions = 0.7301 lies off the beam"),
        ({"positions": -0.1}, "positions = -0.1 lies off the beam"),
        ({"x": [0.2, -1e-3]}, "x = -0.001 lies off the beam"),
        ({"x": np.nan}, "x = nan lies off the beam"),
        ({"frequencies_hz": [300.0, -411.0]}, "frequencies_hz[1] = -411.0"),
        ({"frequencies_hz": [300.0, 411.0, np.nan]}, "frequencies_hz[2] = nan"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
@pytest.mark.parametrize(
    "beam", [STRIP, replace(STRIP, mass=(PointMass(position=0.2, mass=0.1),))], ids=["bare", "mass"]
)
@pytest.mark.parametrize("model", MODELS)
def test_unit_responses_that_cannot_be_are_refused_by_every_model_alike(model, beam, wrong, said):
    """A place off the beam was read as if there were a beam, a frequency below zero as one above."""
    face, count = MODELS[model]
    given = {"positions": [0.1, 0.42], "frequencies_hz": [300.0, 411.0], "x": [0.2, 0.6]} | wrong
    size = {f"n_{COUNTS[model]}": count[0]} if count else {}
    refused(lambda: face.unit_responses(beam, **given, **size), said, "give ")


def test_an_exact_shape_is_read_at_a_number_a_list_and_a_table():
    values = analytic_modes.mode_shape(STRIP, 5, np.array([0.1, 0.4]))
    assert analytic_modes.mode_shape(STRIP, 5, 0.4).tolist() == [values[1]]
    assert np.array_equal(analytic_modes.mode_shape(STRIP, np.int64(5), [[0.1, 0.4]]), values[None])
    assert analytic_modes.mode_shapes(STRIP, 4, 0.4).shape == (4, 1)


@pytest.mark.parametrize("model", MODELS)
def test_the_modes_of_motion_are_read_at_a_number_too(model):
    face, count = MODELS[model]
    basis = face.time_basis(STRIP, *(count or (9,)))
    assert basis.deflection(0.3).shape == (len(basis.omegas), 1)
    assert np.array_equal(basis.deflection([0.1, 0.3])[:, 1:], basis.deflection(0.3))
    refused(lambda: basis.deflection(0.9), "lies off the beam")


# ---------------------------------------------------------------------------------------------------- numpy's scalars


@pytest.mark.parametrize("kind", [np.int64, np.int32, np.uint8])
@pytest.mark.parametrize("model", MODELS)
def test_numpys_whole_numbers_are_counts(model, kind):
    face, count = MODELS[model]
    found = face.solve_modes(STRIP, kind(3), *(kind(n) for n in count))
    assert np.array_equal(found.frequencies_hz, modes_of(model).frequencies_hz)
    field = face.solve_harmonic(STRIP, FORCE, np.int64(411), *(kind(n) for n in count))
    assert field.deflection(0.41) == field_of(model).deflection(0.41)
    assert type(field.frequency_hz) is int
    assert field.count is None or type(field.count) is int


@pytest.mark.parametrize("model", MODELS)
def test_a_short_float_for_a_frequency_does_not_shorten_the_field(model):
    """Numpy would carry 32 bits through: seven digits."""
    assert field_of(model, hertz=np.float32(411.0)).deflection(0.41) == field_of(model).deflection(0.41)


def test_a_beam_of_numpys_scalars_and_lists_is_the_beam_of_pythons():
    def beam(number, whole, many):
        return Beam(
            length=whole(1),
            width=number(0.25),
            thickness=number(0.0078125),
            youngs_modulus=whole(7 * 10**10),
            density=2700.0,
            supports=many(["clamped", "free"]),
            section=many([Section(length=number(0.25), thickness=0.015625), Section(length=0.75)]),
            mass=many([PointMass(position=number(0.5), mass=0.125)]),
        )

    plain, typed = beam(float, float, tuple), beam(np.float32, np.int64, list)
    assert typed == plain
    assert hash(typed) == hash(plain)
    assert typed.bending_stiffness == plain.bending_stiffness
    assert type(typed.length) is int
    assert replace(plain, mass=PointMass(position=0.5, mass=0.125)) == plain


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"supports": "pinned"}, "beam.supports = 'pinned': give two"),
        ({"supports": None}, "beam.supports = None: give two"),
        ({"supports": ["pinned", 3]}, "beam.supports has 3"),
        ({"mass": 0.3}, "beam.mass has 0.3: give a PointMass, or a list of them"),
        ({"section": [0.3, 0.43]}, "beam.section has 0.3: give a Section"),
        ({"spring": [PointMass(position=0.1, mass=1.0)]}, "give a PointSpring"),
        ({"length": np.array([0.73])}, "beam.length"),
        ({"length": "0.73"}, "beam.length = '0.73'"),
    ],
    ids=str,
)
def test_a_beam_of_the_wrong_kinds_is_refused(wrong, said):
    refused(lambda: replace(STRIP, **wrong), said)


# ----------------------------------------------------------------------------------------------- waves and simulate


def test_a_window_is_any_two_numbers():
    field = field_of("analytic", hertz=2911.0)
    window = (0.21, 0.63)
    found = wave.measure(field, window).reflection
    assert wave.measure(field, list(window)).reflection == found
    assert wave.measure(field, np.array(window)).reflection == found
    for wrong in (0.3, None, (0.1,), (0.1, 0.2, 0.3), ("a", "b")):
        refused(lambda wrong=wrong: wave.measure(field, wrong), "window = ", "give start and end in metres")
    refused(lambda: wave.measure(field, [0.63, 0.21]), "window = [0.63, 0.21]", "ascending")


def test_ellipses_are_read_at_a_number_and_a_list():
    field, x = field_of("analytic"), [0.2, 0.5]
    many = wave.ellipse(wave.surface_motion(STRIP, list(field.slope(x))), list(field.deflection(x)))
    one = wave.ellipse(wave.surface_motion(STRIP, field.slope(0.5)), field.deflection(0.5))
    assert [float(part[0]) for part in one] == pytest.approx([part[1] for part in many], rel=1e-12)
    assert all(np.shape(part) == (1,) for part in one)


def test_waves_are_fitted_to_lists():
    x = np.linspace(0.1, 0.3, 40)
    w = 2e-6 * np.exp(-31j * (x - 0.2)) + 0.7e-6 * np.exp(31j * (x - 0.2))
    assert wave.fit_waves(list(x), list(w), 31.0).reflection == pytest.approx(0.35, rel=1e-12)


def test_series_are_lists_too():
    t = np.linspace(0.0, 0.02, 801)
    turn = np.cos(2 * np.pi * 150.0 * t + 0.4)
    found = wave.phasors(list(t), [[3e-6 * value] for value in turn], 150.0)
    assert found[0] == pytest.approx(3e-6 * np.exp(0.4j), rel=1e-9)
    refused(lambda: wave.phasors("now", [[1.0]], 150.0), "times = 'now'")


def test_simulate_takes_a_force_alone_a_place_alone_and_numpys_scalars():
    asked = {"samples": 5, "ledger": False}
    whole = verify.simulate(STRIP, [FORCE], 411.0, 2e-3, count=17, at=[0.3], **asked)
    short = verify.simulate(STRIP, FORCE, np.int64(411), np.float64(2e-3), count=np.int64(17), at=0.3, **asked)
    assert whole.deflection.shape == (5, 1)
    assert np.array_equal(short.deflection, whole.deflection)
    refused(lambda: verify.simulate(STRIP, FORCE, 411.0, 2e-3, count=17, at="middle"), "at = 'middle'")
    refused(lambda: verify.simulate(STRIP, 1.0, 411.0, 2e-3, count=17), "forces has 1.0")


@pytest.mark.parametrize("at", [[[0.3, 0.2]], [[]], np.zeros((0, 2))], ids=["a table", "no rows", "no columns"])
@pytest.mark.parametrize("model", MODELS)
def test_places_of_a_motion_stand_in_one_row(model, at):
    size = {"model": model, "count": MODELS[model][1][0] if MODELS[model][1] else None, "at": at, "samples": 3}
    for asked in (
        lambda: verify.simulate(STRIP, FORCE, 411.0, 2e-3, **size),
        lambda: verify.simulate(STRIP, FORCE, 411.0, 2e-3, start="steady", **size),
        lambda: verify.free_vibration(STRIP, 1, 2e-3, amplitude=1e-3, **size),
    ):
        refused(asked, f"at has the shape {np.shape(at)}: give a number, or numbers in one row (metres)")


# -------------------------------------------------------------------------------------------------- what is exported


def test_the_verbs_are_exported_and_listed():
    assert set(dir(verify)) == set(verify.__all__)
    for name in verify.__all__:
        assert getattr(verify, name) is not None
        assert name in verify.__doc__ or name == "__version__"
    assert verify.analytic_modes.solve_modes is analytic_modes.solve_modes
    with pytest.raises(AttributeError, match="sumulate"):
        _ = verify.sumulate


@pytest.mark.parametrize(
    "first",
    ["from verify import simulate", "import verify.simulate", "from verify.simulate import simulate", "import verify"],
)
def test_simulate_is_the_verb_whichever_way_it_is_imported(first):
    code = (
        f"{first}\nimport verify\nfrom verify import simulate as a\nfrom verify.simulate import simulate as b, Motion\n"
        "from inspect import signature\nassert callable(a) and a is verify.simulate and a.simulate is b\n"
        "assert signature(a) == signature(b) and list(signature(a).parameters)[0] == 'beam'\n"
        "beam = verify.Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)\n"
        "force = verify.PointForce(position=0.1)\n"
        "assert a(beam, force, 411.0, 1e-3, count=5).end.q.tolist() == b(beam, force, 411.0, 1e-3, count=5).end.q.tolist()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# -------------------------------------------------------------------------------------------------------------- help


def kinds():
    """Every class that the public verbs take or return."""
    import verify.chain.result
    import verify.chain.ride
    import verify.models.time_basis
    import verify.motion.contact

    for name in verify.__all__:
        getattr(verify, name)
    found, asked = [], [Value]
    while asked:
        asked += (below := asked.pop().__subclasses__())
        found += [kind for kind in below if kind.__module__.startswith("verify.")]
    return found


@pytest.mark.parametrize("kind", kinds(), ids=lambda kind: kind.__name__)
def test_help_tells_every_fields_meaning(kind):
    text = pydoc.plain(pydoc.render_doc(kind))
    fields = fields_of(kind)
    assert set(fields) == set(kind.__struct_fields__)
    for name, (_, said) in fields.items():
        assert said, f"{kind.__name__}.{name} says nothing"
        assert f"{name} : " in kind.__doc__
        assert said.splitlines()[0] in text


def test_help_is_told_of_everything_public_that_has_fields():
    public = [getattr(verify, name) for name in verify.__all__]
    public += [wave.WaveMeasures, wave.TwoWaves]
    with_fields = [kind for kind in public if inspect.isclass(kind) and not issubclass(kind, Exception)]
    assert len(with_fields) > 12
    assert all(issubclass(kind, Value) for kind in with_fields)


@pytest.mark.parametrize(
    ("kind", "units"),
    [
        (verify.Modes, ("metres", "1/(m^2 sqrt(kg))", "1/sqrt(kg)")),
        (verify.HarmonicField, ("hertz", "newton", "metres")),
        (verify.WaveMeasures, ("m/s along +x", "watt", "degrees", "m^2")),
        (verify.Beam, ("pascals", "kg/m^3", "N m^2", "newton")),
        (verify.Motion, ("seconds", "m/s", "newton", "joules")),
        (verify.FreeVibration, ("seconds", "joules", "m/s")),
        (verify.Bent, ("radians", "N m", "1/m")),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_help_tells_units(kind, units):
    for unit in units:
        assert unit in pydoc.plain(pydoc.render_doc(kind))


def test_a_beam_tells_the_fields_of_its_section_first_and_what_they_are_unless_given():
    names = list(fields_of(Beam))
    assert names.index("youngs_modulus") < names.index("length")
    assert fields_of(Beam)["tension"][0] == "float = 0.0"
    assert Beam.__doc__.startswith("A straight beam")
    assert STRIP.__doc__ is not None


def test_nothing_reads_the_source_before_help_is_asked_for():
    code = (
        "import linecache, verify\nhere = verify.Beam, verify.Slider, verify.segment_model\n"
        "def read(): return [path for path in linecache.cache if path.endswith('verify/beam.py')]\n"
        "assert not read()\nassert 'tension' in verify.Beam.__doc__\nassert read()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
