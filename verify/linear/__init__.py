"""What models of a vibrating beam share: the interface, factored systems, modes, fields, time bases, division."""
