"""The questions of the command line as functions: how many parts, whose frequencies, which joints, how far trusted."""
