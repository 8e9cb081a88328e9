"""Curves through data, each by one published method."""
