"""Linear beams in time, alone or with sliders in contact: exact free motion, contact forces solved step by step."""
