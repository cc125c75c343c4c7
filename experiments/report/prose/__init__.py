"""Pages made from templates and tables."""
