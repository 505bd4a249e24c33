"""Other multibody engines on the same chain and slider, each behind one interface; none is imported before its use."""

from verify.engines.base import ENGINES, Chain, Engine, Rider, Run, chain_of, missing, rider_of

__all__ = ["ENGINES", "Chain", "Engine", "Rider", "Run", "chain_of", "missing", "rider_of"]
