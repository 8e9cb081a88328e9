"""Tests of the kernel for two horizontal components."""
