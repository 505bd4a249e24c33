"""The nonlinear chain of rigid links: equilibria, exact linearisation, motion in time, sliders and feet."""
