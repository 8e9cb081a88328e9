"""Tests of the physics layer."""
