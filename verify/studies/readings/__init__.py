"""What a source leaves open about its slider, gone through."""
