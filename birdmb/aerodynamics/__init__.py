"""Quasi-steady lifting-line loads on the moving wing (compiled kernels)."""
