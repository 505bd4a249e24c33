"""Models with their settings side by side: which stand there, which make a difference on a beam, what a choice shows."""

import pytest
from msgspec.structs import replace
from packaged_beams import packaged_beam

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.judge.cache import SolutionCache
from verify.judge.sizing import choose_of_all
from verify.judge.variants import Rules, Variant, beside, every_rule, falls_within
from verify.section import Section

CANTILEVER = packaged_beam("steel-cantilever")
BOTH = ("segment", "fem")


def labels(variants):
    return [one.label for one in variants]


def test_a_setting_turns_the_models_that_have_it_and_leaves_the_others():
    assert labels(Rules().variants(BOTH)) == ["segment", "fem"]
    assert labels(Rules(wall="half").variants(BOTH)) == ["segment wall=half", "fem"]
    assert labels(Rules(theory="timoshenko").variants(BOTH)) == ["segment theory=timoshenko", "fem theory=timoshenko"]
    several = Rules(wall=("gregory", "half"), grading=1.7)
    assert labels(several.variants(BOTH)) == ["segment grading=1.7", "segment wall=half grading=1.7", "fem grading=1.7"]
    assert several.combinations == ((("grading", 1.7),), (("wall", "half"), ("grading", 1.7)))
    assert several.several == ("wall",)


def test_a_setting_that_no_model_has_is_refused():
    with pytest.raises(InputError, match=r"wall = 'half' is a setting of none of fem: leave it out"):
        Rules(wall="half").variants(["fem"])


def test_the_rules_that_make_a_difference_are_those_of_what_the_beam_has():
    assert every_rule(packaged_beam("paper")) == ()
    walls = labels(every_rule(CANTILEVER))
    assert walls == [f"segment wall={wall}" for wall in ("half", "welded", "third-order", "five-joint")]
    stepped = replace(
        CANTILEVER, section=(Section(length=0.25), Section(length=CANTILEVER.length - 0.25, youngs_modulus=70e9))
    )
    assert "segment joints=printed" in labels(every_rule(stepped))
    assert "segment wall=welded" not in labels(every_rule(stepped))
    taut = replace(CANTILEVER, tension=80.0, mass=(PointMass(position=0.1, mass=0.02),))
    assert labels(every_rule(taut))[-2:] == ["segment joints=tensioned", "segment attachment=lever"]
    assert labels(every_rule(CANTILEVER, (("theory", "timoshenko"),)))[0] == "segment wall=half theory=timoshenko"


def test_beside_the_default_stands_the_literatures_wall_and_the_joint_that_axial_force_mends():
    assert labels(beside(CANTILEVER)) == ["segment wall=half"]
    assert labels(beside(packaged_beam("taut-strip"))) == ["segment joints=tensioned"]
    assert beside(packaged_beam("free-free-bar")) == ()


def test_errors_go_up_and_down_with_their_number_of_parts_where_something_may_fall_within_one_and_at_no_end():
    ends = (PointMass(position=0.0, mass=0.3), PointMass(position=CANTILEVER.length, mass=0.2))
    springs = (PointSpring(position=0.0, rotational=3.0), PointSpring(position=CANTILEVER.length, stiffness=40.0))
    bar = replace(CANTILEVER, supports=("free", "free"))
    assert not falls_within(replace(bar, mass=ends, spring=springs))
    assert falls_within(replace(bar, mass=(*ends, PointMass(position=0.17, mass=1e-3))))
    assert falls_within(replace(bar, spring=(*springs, PointSpring(position=0.17, stiffness=2.0))))
    assert falls_within(replace(CANTILEVER, section=(Section(length=0.17), Section(length=CANTILEVER.length - 0.17))))


def test_a_choice_shows_69_links_of_the_literature_beside_19():
    choices, left_out = choose_of_all(SolutionCache(CANTILEVER), 5, 1e-3)
    found = {one.variant.label: one.count for one in choices}
    assert found["segment"] == 19
    assert found["segment wall=half"] == 69
    assert not left_out


def test_under_tension_a_choice_shows_the_joint_that_needs_a_sixth_of_the_links():
    found = {
        one.variant.label: one.count for one in choose_of_all(SolutionCache(packaged_beam("taut-strip")), 3, 1e-3)[0]
    }
    assert (found["segment"], found["segment joints=tensioned"]) == (56, 10)


def test_the_theoretical_orders_are_told_for_the_beam_at_hand():
    orders = {
        "gregory": Variant("segment").order(CANTILEVER),
        "half": Variant("segment", (("wall", "half"),)).order(CANTILEVER),
        "stepped": Variant("segment").order(packaged_beam("stepped-beam")),
        "printed": Variant("segment", (("joints", "printed"),)).order(packaged_beam("stepped-beam")),
        "taut": Variant("segment").order(packaged_beam("taut-strip")),
        "tensioned": Variant("segment", (("joints", "tensioned"),)).order(packaged_beam("taut-strip")),
        "elements": Variant("fem").order(packaged_beam("stepped-beam")),
    }
    assert orders == {
        "gregory": 4,
        "half": 2,
        "stepped": 2,
        "printed": 1,
        "taut": 2,
        "tensioned": 4,
        "elements": 4,
    }


def test_a_clamp_that_gives_has_the_order_of_its_wall_joint_too():
    beam = Beam(
        length=0.73,
        bending_stiffness=3.55,
        mass_per_length=0.32,
        supports=("free", "free"),
        spring=(PointSpring(position=0.0, stiffness=4e3, rotational=31.0),),
    )
    orders = {wall: Variant("segment", (("wall", wall),)).order(beam) for wall in ("half", "third-order", "gregory")}
    assert orders == {"half": 2, "third-order": 3, "gregory": 4}


def test_a_wall_that_makes_no_difference_is_said_to_make_none():
    _, left_out = choose_of_all(SolutionCache(packaged_beam("paper")), 3, 1e-2, Rules(wall="half", attachment="lever"))
    assert left_out == {
        "wall": "it makes no difference here, no end is clamped",
        "attachment": "it makes no difference here, nothing stands on the beam",
    }
    assert not choose_of_all(SolutionCache(CANTILEVER), 3, 1e-2, Rules(wall="half"))[1]


def test_an_elastic_clamp_is_a_wall_and_a_spring_on_the_way_is_none():
    arm = packaged_beam("instrument-arm")
    assert labels(beside(arm)) == ["segment wall=half", "segment attachment=lever"]
    assert labels(every_rule(arm))[0] == "segment wall=half"
    on_the_way = replace(arm, supports=("pinned", "free"), spring=(replace(arm.spring[0], position=0.3),))
    assert labels(beside(on_the_way)) == ["segment wall=half", "segment attachment=lever"]  # the instrument's inertia
    light = tuple(replace(one, rotary_inertia=0.0) for one in arm.mass)
    assert labels(beside(replace(on_the_way, mass=light))) == ["segment attachment=lever"]


def test_a_choice_sets_other_rules_beside_each_of_several_theories():
    rules = Rules(theory=("timoshenko", "rayleigh"), joints=("tensioned", "series"))
    found = {one.variant.label: one.count for one in choose_of_all(SolutionCache(CANTILEVER), 2, 1e-2, rules)[0]}
    for theory in ("rayleigh", "timoshenko"):
        alone = Rules(theory=theory, joints=rules.joints)
        own = {one.variant.label: one.count for one in choose_of_all(SolutionCache(CANTILEVER), 2, 1e-2, alone)[0]}
        assert own == {label: count for label, count in found.items() if label.endswith(theory)}
        assert f"segment wall=half joints=tensioned theory={theory}" in own


def test_bodies_on_rigid_links_stand_beside_wherever_they_differ():
    on_the_way = replace(CANTILEVER, mass=(PointMass(position=0.1, mass=0.02),))
    at_the_end = replace(CANTILEVER, mass=(PointMass(position=CANTILEVER.length, mass=0.02),))
    assert labels(beside(on_the_way)) == ["segment wall=half", "segment attachment=lever"]
    assert labels(beside(at_the_end)) == ["segment wall=half"]
    chosen = labels(beside(on_the_way, (("wall", "half"),)))
    assert chosen[-1] == "segment wall=half attachment=lever"
    heavy = replace(on_the_way, mass=(PointMass(position=0.1, mass=0.2),))
    found = {one.variant.label: one.count for one in choose_of_all(SolutionCache(heavy), 4, 1e-3)[0]}
    assert (found["segment"], found["segment attachment=lever"]) == (15, 22)
