"""Which engines there are, which are installed, and each behind one interface; nothing is imported to say so."""

from collections.abc import Callable
from typing import Protocol

from verify.errors import InputError
from verify.field_docs import Value
from verify.models.arrays import Array
from verify.peers.case import Case, PeerRun, Sled
from verify.registry import Registry

EXTRA = "pip install 'fem-segment-verify[peers]'"

Prepared = Callable[[float, float], PeerRun]
"""(step, end), seconds -> the motion from rest, in steps of at most about that step."""


class PeerAdapter(Protocol):
    """An engine by the verbs of this room."""

    def frequencies(self, case: Case) -> Array | None:
        """(n_modes,), Hz, ascending; None where the engine has none."""

    def prepare(self, case: Case, sled: Sled | None = None) -> Prepared:
        """A run of the chain, and of a slider on it; what can be made beforehand is."""


class Peer(Value, frozen=True, kw_only=True):
    """An engine and where its adapter lives."""

    name: str
    """As tables call it."""
    package: str
    """As pip knows it."""
    module: str
    """As Python imports it."""
    home: str
    """'module:class' of its adapter, which is made without arguments."""
    implicit: bool = False
    """Whether its steps have no limit of stability."""
    dense: bool = True
    """Whether a step takes time by links squared, its matrices being full."""


def _wrong(peer: object) -> str:
    """What an engine from outside cannot be."""
    return "" if isinstance(peer, Peer) else "is no verify.peers.catalogue.Peer: make it one"


PEERS: Registry[Peer] = Registry(
    "peer",
    "verify.peers",
    own=(
        Peer(
            name="Exudyn",
            package="exudyn",
            module="exudyn",
            home="verify.peers.exudyn:Exudyn",
            implicit=True,
            dense=False,
        ),
        Peer(name="MuJoCo", package="mujoco", module="mujoco", home="verify.peers.mujoco:Mujoco"),
        Peer(name="Pinocchio", package="pin", module="pinocchio", home="verify.peers.pinocchio:Pinocchio", dense=False),
    ),
    refuses=_wrong,
)


def installed(peer: Peer) -> str | None:
    """The version that is installed, without importing it; None where it is not."""
    from importlib.metadata import PackageNotFoundError, version
    from importlib.util import find_spec

    if find_spec(peer.module) is None:
        return None
    try:
        return version(peer.package)
    except PackageNotFoundError:
        return "of unknown version"


def missing(peer: Peer) -> str:
    """Why an engine takes no part, and what to do; empty where it is installed."""
    if installed(peer) is not None:
        return ""
    own = peer.name in PEERS.built_in
    return f"{peer.name} is not installed: {EXTRA if own else f'pip install {peer.package}'}, or go without it"


def adapter(peer: Peer) -> PeerAdapter:
    """The engine itself, imported now. Raises InputError, naming the remedy, where it is not installed."""
    from importlib import import_module

    if why := missing(peer):
        raise InputError(f"peer = {peer.name!r}: {why}")
    module, _, attribute = peer.home.partition(":")
    made: PeerAdapter = getattr(import_module(module), attribute)()
    return made
