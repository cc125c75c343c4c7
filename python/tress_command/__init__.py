"""The command ./tress. It needs the standard library only: it runs before anything is built."""
