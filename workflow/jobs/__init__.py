"""Functions of the rules: from the paths of input files and from settings to output files.

A rule names one in `params.run`; it gets, by the names of its arguments, the rule's values (see
``workflow/scripts/adapter.py``). A rule depends on all that the module of its function imports, so
that functions with other imports stand in other modules.
"""
