"""From a point of a study to its results: everything here decides about stored numbers."""
