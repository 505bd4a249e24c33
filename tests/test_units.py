"""No figure knows its units: a beam told in other ones, by powers of two, has the same digits in those.

What is compared with a length, a force or a time that nobody gave would show: a tolerance in metres, a step in seconds.
"""

import numpy as np
import pytest
from every_verb import CASES, Units

OTHERS = [Units(2.0**-17, 2.0**9, 2.0**-11), Units(2.0**11, 2.0**-23, 2.0**8), Units(2.0**30, 2.0**4, 2.0**-27)]


@pytest.mark.parametrize("units", OTHERS, ids=["small", "large", "vast"])
@pytest.mark.parametrize("case", CASES)
def test_figures_are_the_same_in_any_units(case, units):
    verb, *given = CASES[case]
    for (_, expected), (told, found) in zip(verb(Units(), *given), verb(units, *given), strict=True):
        values, wanted = np.asarray(found), np.asarray(told(np.asarray(expected)))
        assert np.isfinite(wanted).all()
        assert abs(values - wanted).max() <= 1e-9 * abs(wanted).max()
