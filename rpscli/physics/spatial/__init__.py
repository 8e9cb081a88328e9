"""The podium on a ground that moves in x, in y and up: columns tilt to any side."""
