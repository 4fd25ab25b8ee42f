"""Many runs of one model: what `carom.ensemble` is made of. docs/ensembles.md shows it."""
