"""./tress compare."""
