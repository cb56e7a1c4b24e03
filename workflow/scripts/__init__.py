"""Scripts of the rules: what is called for a job, with which files and settings."""
