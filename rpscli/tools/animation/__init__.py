"""Films of histories and of modes."""

OFFERS = {
    "films": {
        "history": "rpscli.tools.animation.film:of_history",
        "modes": "rpscli.tools.animation.film:of_modes",
    },
}
