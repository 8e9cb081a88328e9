"""The laws, each once, of plain named numbers (Theory, sections 1, 2, 12 and 13).

The tilt is a vector (a, b) = x (cos phi, sin phi); along it and across it its rate is p =
x' and q = x phi'. One plane is its first component alone, signed by the side s: x = s a
may then pass through zero, and nothing across it exists. With K = J/x^2, over N m_c R^2,

    A r''_n = C z_n - arms - bed - c_r p + G_n + [(K - A)/x + K'/2] q^2 - D p^2        D = A'/2
    K r''_t = h z_t - c_t q + G_t - K' p q                                             h = u/x
    u_b''   = 2 R (C r''_n + B p^2 + h' q^2) along it,  2 R (h r''_t + 2 h' p q) across it
    z       = 2 (V + P)/(N m_c R) - (1 + 2 gamma) a_g/R
    arms    = [(B - sink w) g + B_v (g_f - g)] (1 + 2 gamma + 2 gamma eta)/R,   B_v = B - root w
    g_f     = g + a_v, of floors on springs less than it by 2 [M_tot a_v + sum Gamma f]/(N m_c)
              over 1 + 2 gamma + 2 gamma eta: they press with M_tot g - sum Gamma f (14.3)

G is what tendons and rolling resistance do, P what dampers and stops push the cap
beam with. Kept beyond the ends of a phase of motion all is smooth, which is what
the search of events needs.

`geometry` and `plane_bed` are the contacts, for arrays as well; `place` is geometry
and inertia at a tilt, `motion` the equation of motion, `contacts` the forces that
follow. `lane` asks them.
"""
