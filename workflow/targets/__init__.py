"""What the rules ask of a project: files of blades, scenes and experiments, settings, and code.

Functions that take ``wildcards`` are called by Snakemake for each job: these have the attributes
blade, scene, experiment, block, row, as far as the outputs of the rule do. Errors are
``SettingsError``, which name the user's file.
"""
