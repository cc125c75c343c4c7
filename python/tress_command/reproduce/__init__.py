"""./tress reproduce, ./tress rerun and ./tress archive."""
