"""What combines under a slider that may leave the beam is a table; every cell of it is run, or refused by name."""

import pytest
from msgspec.structs import replace

from verify import Beam, Contact, Foot, InputError, PointForce, PointSpring, Slider, run_motor, simulate
from verify.motor.combine import combinations

BEAM = Beam(length=0.31, width=0.013, thickness=0.0012, youngs_modulus=68e9, density=2650.0, loss_factor=0.01)
FORCES = [PointForce(position=0.021, amplitude=0.4), PointForce(position=0.27, amplitude=0.3, phase_deg=70.0)]
HERTZ = 3130.0
COUNT = {"analytic": None, "segment": 19, "fem": 17, "chain": 13}
FOOT = {"point": (), "foot": (Foot(length=0.03, points=5),), "layer": (Foot(length=0.03, points=7),)}


def slider(friction, normal, shape, coupling):
    """One of that kind, light enough that a beam which feels it is hardly loaded."""
    contact = None if normal == "always on" else Contact(restitution=0.3) if normal == "hard" else springs(shape)
    return Slider(
        mass=0.003,
        mu=0.23,
        slope=90.0 if friction == "tanh" else None,
        law=friction,
        preload=0.05,
        position=0.171,
        coupling=coupling,
        contact=contact,
        foot=FOOT[shape],
    )


def springs(shape):
    if shape == "layer":
        return Contact(layer_stiffness=2e6, layer_tangential_stiffness=1e6, damping=0.2)
    return Contact(stiffness=6e4, damping=0.2)


def run(field, friction, normal, shape, coupling):
    """The run by the verb that the table names."""
    asked, beam = (
        slider(friction, normal, shape, coupling),
        replace(BEAM, loss_factor=0.0) if field == "chain" else BEAM,
    )
    if field == "chain" and normal == "always on":
        from verify.chain.ride import ride_from_rest

        return ride_from_rest(beam, FORCES, HERTZ, asked, COUNT[field], 6e-4, step=1e-5)
    start = {"start": "rest", "modal_damping": 0.0} if field == "chain" else {"start": "steady"}
    kept = {"model": field, "count": COUNT[field], "samples": 5, **start}
    if normal == "always on":
        return simulate(BEAM, FORCES, HERTZ, 6e-4, slider=asked, **kept)
    return run_motor(beam, FORCES, HERTZ, 6e-4, slider=asked, **kept)


@pytest.mark.parametrize("cell", combinations(), ids=lambda cell: " ".join(cell[:5]))
def test_every_cell_is_run_as_the_table_says_or_refused_by_name(cell):
    *case, how = cell
    if how.startswith("refused"):
        with pytest.raises(InputError, match=r"slider|hard|foot"):
            run(*case)
        return
    found = run(*case)
    assert found.statistics.finished
    assert found.speed[-1] != 0.0
    assert found.coupling is None or found.coupling.two_way == (case[4] == "two-way")


def test_the_table_has_every_cell_once_and_refuses_none_without_a_reason():
    cells = combinations()
    assert len({cell[:5] for cell in cells}) == len(cells) == 4 * 2 * 3 * 3 * 2
    assert {cell[5].partition(":")[0] for cell in cells} == {"run_motor", "simulate", "chain.ride", "refused"}
    assert all(len(cell[5]) > len("refused: ") + 10 for cell in cells if cell[5].startswith("refused"))


@pytest.mark.parametrize(
    ("friction", "shape"),
    [("tanh", "point"), ("tanh", "foot"), ("coulomb", "point"), ("coulomb", "foot"), ("coulomb", "layer")],
)
def test_a_beam_that_feels_its_slider_moves_it_otherwise_than_one_that_does_not(friction, shape):
    one, two = (run("fem", friction, "springs", shape, coupling) for coupling in ("one-way", "two-way"))
    assert abs(one.height[-1, 0] / two.height[-1, 0] - 1.0) > 1e-6
    assert one.speed[-1] != two.speed[-1]


def _bar(**given):
    """A bar of a motor, free at both ends unless something holds it."""
    own = {"length": 0.06, "width": 0.006, "thickness": 0.002, "youngs_modulus": 105e9, "density": 8500.0}
    return Beam(supports=("free", "free"), loss_factor=0.01, **own, **given)


def test_a_slider_runs_one_way_on_the_steady_field_of_a_beam_that_nothing_holds():
    """As on one that lies on soft springs, which have a sag; and alike on the exact beam."""
    forces = (PointForce(position=0.008, amplitude=2.0), PointForce(position=0.052, amplitude=1.5, phase_deg=70.0))
    contact = Contact(stiffness=5e6, damping=30.0)
    slider = Slider(mass=2e-3, mu=0.3, slope=60.0, preload=8.0, position=0.031, coupling="one-way", contact=contact)
    lying = _bar(spring=tuple(PointSpring(position=x, stiffness=10.0) for x in (0.0, 0.06)))
    asked = {"slider": slider, "samples": 3}
    exact = run_motor(_bar(), forces, 31e3, 1e-3, model="analytic", **asked)
    assert abs(exact.travelled[-1]) > 5e-8
    for model, count in (("segment", 31), ("fem", 40)):
        free, held = (
            run_motor(beam, forces, 31e3, 1e-3, model=model, count=count, **asked) for beam in (_bar(), lying)
        )
        assert free.motor_margins.sag is None
        assert held.motor_margins.sag > 0.1
        assert free.travelled == pytest.approx(held.travelled, rel=1e-5)
        assert free.travelled == pytest.approx(exact.travelled, rel=5e-3)


def test_a_beam_that_nothing_holds_is_refused_where_it_feels_its_slider():
    slider = Slider(mass=2e-3, mu=0.3, preload=8.0, coupling="two-way", contact=Contact(stiffness=5e6))
    with pytest.raises(InputError, match=r"beam.supports = \['free', 'free'\] leave 2 rigid .*give beam.spring"):
        run_motor(_bar(), PointForce(position=0.008), 31e3, 1e-4, slider=slider, model="fem", count=17)
