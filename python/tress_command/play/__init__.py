"""./tress play: a live view of a scene in the browser."""
