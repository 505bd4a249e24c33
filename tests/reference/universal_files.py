"""Universal files of measured modes along x, written by pyuff."""

import numpy as np

MODE = {f"id{i}": "a" for i in range(1, 6)} | {"model_type": 1, "data_ch": 2, "spec_data_type": 8}
MODE |= {"modal_m": 1.0, "modal_damp_vis": 0.0, "modal_damp_his": 0.0}
RESPONSE = {f"id{i}": "a" for i in range(1, 6)} | {
    "binary": 0,
    "func_type": 4,
    "rsp_dir": 3,
    "ref_dir": 3,
    "ref_node": 14,
}
RESPONSE |= {"rsp_ent_name": "NONE", "ref_ent_name": "NONE", "ord_data_type": 5, "abscissa_spacing": 1, "ver_num": 0}
RESPONSE |= {"abscissa_min": 1.0, "abscissa_inc": 0.25, "z_axis_value": 0.0, "load_case_id": 0}
RESPONSE |= {"abscissa_spec_data_type": 18, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 13}


def write_universal(path, kind, hertz, x, shapes):
    """Points and shapes (k, n) as modes, set 55, or as responses of 0.2 % damping to a force at the last, set 58."""
    import pyuff

    zero, nodes, file = 0.0 * x, np.arange(1, len(x) + 1), pyuff.UFF(str(path))
    points = {"type": 15, "node_nums": nodes, "def_cs": nodes, "disp_cs": nodes, "color": nodes}
    file.write_sets(points | {"x": x, "y": zero, "z": zero})
    if kind == 55:
        names = {"analysis_type": 2, "data_type": 2, "n_data_per_node": 3, "mode_n": 1, "load_case": 0}
        for f, shape in zip(hertz, shapes, strict=True):
            vectors = {"node_nums": nodes, "r1": zero, "r2": zero, "r3": shape}
            file.write_sets(pyuff.prepare_55(**MODE, **names, freq=float(f), **vectors))
        return
    w = np.arange(1.0, 600.0, 0.25)
    for node, at in zip(nodes, shapes.T, strict=True):
        terms = zip(at, shapes[:, -1], hertz, strict=True)
        data = sum(a * b / (f**2 - w**2 + 0.004j * f * w) for a, b, f in terms)
        file.write_sets(pyuff.prepare_58(**RESPONSE, rsp_node=int(node), num_pts=len(w), data=data, x=w))
