"""The chain of rigid bodies of a beam, with the joints of `SegmentModel`."""

from verify.engines.description import RigidChain, rigid_chain
from verify.problem.beam import Beam
from verify.segment_model import SegmentModel
from verify.settings import DEFAULT


def describe(
    beam: Beam, count: int, *, wall: str = DEFAULT.wall, in_space: bool = False, damping: float = 0.0
) -> RigidChain:
    """The chain of `count` links of a beam. Raises InputError for what rigid links and springs do not model.

    `wall`: a rule whose joint 0 is at the wall. `damping`: damping ratio of the first mode about every axis. Joint 0 is
    at the end with the stronger support.
    """
    return rigid_chain(SegmentModel, beam, count, wall, in_space, damping)
