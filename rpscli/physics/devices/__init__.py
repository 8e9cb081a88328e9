"""Devices of the rocking storey: what they do, and where their laws change (section 11).

Dampers and stops push the cap beam, a tendon pulls both ends of its column
together, rolling resistance turns the columns back. Which branch of its law a
device follows is part of the state, so that all is smooth within a step; a law
changes where a watched value falls below zero. A device is a file here, whose
`DEVICE` (`device`) is a row of `table`.

Friction in one plane has the sign of `direction`. Where the tilt may have any azimuth it
acts along the velocity, which seldom is zero: what comes to a stop is held, or turns at
once to where it is pushed (13.25).

`worked` says how devices are worked, `acting` what all of a lane do together, `branches`
where laws change, and `seen` what is kept of them.
"""
