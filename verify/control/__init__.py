"""Control of a motor: speed and position of the slider, resonance tracking, two-phase drive of the wave."""
