"""Full contact: the building on a fixed base, solved exactly, until the storey uplifts."""
