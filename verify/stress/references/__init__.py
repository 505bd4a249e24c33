"""What rows are judged by: the beams that are pushed, matrices written out, fifty digits, the textbook's way."""
