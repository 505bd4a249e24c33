"""Which engines there are, what is said of one that is not there, and one from outside."""

import subprocess
import sys
from importlib.machinery import ModuleSpec
from types import ModuleType

import msgspec
import numpy as np
import pytest

from verify.errors import InputError
from verify.peers import references
from verify.peers.case import PeerRun
from verify.peers.catalogue import PEERS, Peer, adapter, installed, missing

NOBODY = Peer(name="Nobody", package="no-such-engine", module="no_such_engine", home="no_such_engine:Nobody")


def test_the_three_engines_are_known_by_name_and_a_slip_of_the_pen_is_put_right():
    assert PEERS.own() == ("Exudyn", "MuJoCo", "Pinocchio")
    with pytest.raises(InputError, match="did you mean 'MuJoCo'"):
        PEERS.named("mujocoo")


def test_nothing_is_imported_to_say_what_is_installed():
    code = (
        "import sys; from verify.peers.catalogue import PEERS, installed, missing\n"
        "said = [installed(peer) or missing(peer) for peer in PEERS.values()]\n"
        "print(len([word for word in said if word]), sorted({'exudyn', 'mujoco', 'pinocchio'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["3", "[]"]


def test_an_engine_that_is_not_there_is_named_with_the_remedy(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for peer in PEERS.values():
        assert installed(peer) is None
        assert missing(peer).startswith(f"{peer.name} is not installed: pip install 'fem-segment-verify[peers]'")
        with pytest.raises(InputError, match=rf"{peer.name}.*fem-segment-verify\[peers\]"):
            adapter(peer)


def test_one_from_outside_that_is_not_there_is_asked_for_by_its_own_package():
    with PEERS.registered(NOBODY):
        assert missing(PEERS["Nobody"]) == "Nobody is not installed: pip install no-such-engine, or go without it"
    assert "Nobody" not in PEERS.own()


class Exact:
    """An engine that is right, and breaks beyond a millisecond."""

    def frequencies(self, case):
        return None

    def prepare(self, case, sled=None):
        def run(step, end):
            times = np.arange(step, min(end, 1e-3) + step / 2, step)
            return PeerRun(
                times=times,
                deflection=references.deflection(case, times),
                distance=np.zeros(0),
                speed=np.zeros(0),
                seconds=0.0,
                set_up_s=0.0,
                steps=len(times),
                broke="at t = 0.001 s it went home" if end > 1e-3 else "",
            )

        return run


def test_an_engine_of_ones_own_takes_part_by_the_same_interface(monkeypatch, asymmetric_case):
    module = ModuleType("right_engine")
    module.__spec__, module.Exact = ModuleSpec("right_engine", None), Exact
    monkeypatch.setitem(sys.modules, "right_engine", module)
    own = Peer(name="Right", package="right-engine", module="right_engine", home="right_engine:Exact")
    with PEERS.registered(own):
        assert installed(PEERS["Right"]) == "of unknown version"
        run = adapter(PEERS["Right"]).prepare(asymmetric_case)
        assert adapter(PEERS["Right"]).frequencies(asymmetric_case) is None
    assert run(1e-5, 5e-4).broke == ""
    assert "went home" in run(1e-5, 2e-3).broke


def test_what_is_no_peer_is_refused():
    with pytest.raises(InputError, match=r"peer = 'Exact' is no .*: make it one"):
        PEERS.register(type("Own", (), {"name": "Exact"})())


def test_a_peer_is_a_value():
    assert msgspec.structs.replace(NOBODY, name="Somebody") != NOBODY
    assert hash(NOBODY) == hash(msgspec.structs.replace(NOBODY))
