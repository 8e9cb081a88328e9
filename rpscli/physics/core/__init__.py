"""What kernels of any equation of motion share: records, lanes, series, compilation."""
