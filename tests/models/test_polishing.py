"""Which strains of a solution are read off its vectors."""

from types import SimpleNamespace

import numpy as np
import pytest

from verify.models.polishing import best_read


@pytest.mark.parametrize(("lever", "read"), [(3.0, True), (3e3, False)])
def test_a_soft_spring_is_read_off_the_vector_where_rounding_of_what_it_feels_is_less_than_that_of_the_forces(
    lever, read
):
    """Forces up to 80 N; a spring of 0.2 N/m that feels the ends of a vector by a lever, and a stiff one."""
    felt = np.array([[1.0, -2.0], [lever, 2.0 * lever]])
    pencil = SimpleNamespace(
        stiffness=np.array([4e4, 0.2]), strain_matrix=lambda: felt, strain=lambda vectors: felt @ vectors
    )
    vectors, strains = np.array([[3.0], [1.5]]), np.array([[2e-3], [7.0]])
    found = best_read(pencil, vectors, strains)
    assert found[0, 0] == strains[0, 0]
    assert found[1, 0] == ((felt @ vectors)[1, 0] if read else strains[1, 0])
