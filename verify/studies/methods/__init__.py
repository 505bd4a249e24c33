"""Both ways of driving a travelling wave, side by side."""
