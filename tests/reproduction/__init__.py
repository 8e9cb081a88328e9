"""What the paper's figures and tables say, on data computed from the files of its reproduction."""
