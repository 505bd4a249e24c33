"""Benches: run time against error, of every method that a scene gives something to do.

Takes a scene, the models, the studies' runs and other engines; gives rows (error, time, what each is against) and
sentences, each earned or withheld with the reason. The catalogue of studies and the command `bench` call it.
"""
