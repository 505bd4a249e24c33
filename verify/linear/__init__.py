"""What models of a vibrating beam share: modes, fields, time bases, division, eigenvalues, driven pencils.

Takes beams and matrices, gives frozen results that know how to be read. No model is in here; every room above may
call it. How kernels are compiled and kept stands here too.
"""
