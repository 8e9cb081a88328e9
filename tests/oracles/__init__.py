"""Second solutions that share nothing with the program but the statement of the problem."""
