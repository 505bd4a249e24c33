"""What a person or a script gets to see of a result: the HTML page, the terminal, plain data.

Takes results that tell themselves in tables, charts and facts, gives text; nothing below the doors but this room
writes files. The doors call it.
"""
