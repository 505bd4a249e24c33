"""Other multibody engines on the same chain, each behind one interface; none is imported before its use."""

from verify.engines.base import ENGINES, Chain, Engine, Run, chain_of, missing

__all__ = ["ENGINES", "Chain", "Engine", "Run", "chain_of", "missing"]
