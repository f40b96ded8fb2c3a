"""Benchmarks of the light transport against Radiance."""
