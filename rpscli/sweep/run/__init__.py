"""Who computes the points of a study, in which order, and where a run begins."""
