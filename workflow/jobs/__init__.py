"""Jobs: from the paths of input files and from settings to output files or numbers.

The scripts of the rules, ``workflow/scripts``, call them. A job depends on all that its module
imports, so that functions with other imports stand in other modules. Where a file may be missing
its path is empty.
"""
