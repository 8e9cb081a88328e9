"""Tests of the case layer."""
