"""The commands, a file for each or for a few of a kind. `cli` names them all, and nothing else calls them.

Takes words of a command line, prints what was asked. Every command imports what it needs when it runs, not before.
"""
