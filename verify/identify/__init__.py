"""Somebody else's model of a scene's beam, judged: which of the known family its frequencies are, and how surely.

Takes a list of natural frequencies (a file, or a model class), shapes if there are any, and a scene's beam; gives what
it is, what is wrong with the list, the errors against the exact beam and gates. The doors call it. It stands above
`run`, whose verdicts it gives.
"""
