"""./tress cluster."""
