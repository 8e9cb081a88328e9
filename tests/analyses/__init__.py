"""Tests of the analyses layer."""
