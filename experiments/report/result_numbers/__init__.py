"""Numbers that pages, claims and notebooks use, computed from results/: a module for each study,
whose functions take the tables and return a text, a number or a DataFrame.

    from result_numbers import family
    from result_numbers.tables import Tables
    family.summary(Tables())
"""
