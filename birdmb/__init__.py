"""Limit cycles and Floquet stability of flapping birds."""
