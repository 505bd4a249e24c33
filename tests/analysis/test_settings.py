"""Models with their settings side by side: which stand there, which make a difference on a beam, what a choice shows."""

import pytest
from msgspec.structs import replace

from verify.attached import PointMass
from verify.errors import InputError
from verify.judge.cache import SolutionCache
from verify.judge.sizing import choose_of_all
from verify.judge.variants import Rules, Variant, every_rule
from verify.scene.load import load_scene
from verify.section import Section

CANTILEVER = load_scene("steel-cantilever").beam


def labels(variants):
    return [one.label for one in variants]


def test_a_setting_that_no_model_has_is_refused():
    with pytest.raises(InputError, match=r"wall = 'half' is a setting of none of fem: leave it out"):
        Rules(wall="half").variants(["fem"])


def test_the_rules_that_make_a_difference_are_those_of_what_the_beam_has():
    assert every_rule(load_scene("paper").beam) == ()
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


def test_a_choice_shows_69_links_of_the_literature_beside_19():
    choices, left_out = choose_of_all(SolutionCache(CANTILEVER), 5, 1e-3)
    found = {one.variant.label: one.count for one in choices}
    assert found["segment"] == 19
    assert found["segment wall=half"] == 69
    assert not left_out


def test_under_tension_a_choice_shows_the_joint_that_needs_a_sixth_of_the_links():
    found = {
        one.variant.label: one.count for one in choose_of_all(SolutionCache(load_scene("taut-strip").beam), 3, 1e-3)[0]
    }
    assert (found["segment"], found["segment joints=tensioned"]) == (56, 10)


def test_the_theoretical_orders_are_told_for_the_beam_at_hand():
    orders = {
        "gregory": Variant("segment").order(CANTILEVER),
        "half": Variant("segment", (("wall", "half"),)).order(CANTILEVER),
        "stepped": Variant("segment").order(load_scene("stepped-beam").beam),
        "printed": Variant("segment", (("joints", "printed"),)).order(load_scene("stepped-beam").beam),
        "taut": Variant("segment").order(load_scene("taut-strip").beam),
        "tensioned": Variant("segment", (("joints", "tensioned"),)).order(load_scene("taut-strip").beam),
        "elements": Variant("fem").order(load_scene("stepped-beam").beam),
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
