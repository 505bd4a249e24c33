"""Adapters of other multibody engines for the same chain; an engine is imported on first use."""

from verify.engines.base import ENGINES, Chain, Engine, Run, chain_of, missing

__all__ = ["ENGINES", "Chain", "Engine", "Run", "chain_of", "missing"]
