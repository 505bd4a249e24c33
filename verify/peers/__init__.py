"""Peers: the same uniform pinned chain of rigid links in other engines, Exudyn, MuJoCo and Pinocchio.

Takes a beam, its forces and a slider as values; gives natural frequencies, motions, what an engine did when it broke,
and exact references. Each engine is imported where it is asked for, and only there. Benches call it.
"""
