"""The structure as frozen objects with the published formulae."""
