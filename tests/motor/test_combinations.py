"""What combines under a slider that may leave the beam is a table; every cell of it is run, or refused by name."""

import pytest
from msgspec.structs import replace

from verify import Beam, Contact, Foot, InputError, PointForce, Slider, run_motor, simulate
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
