"""Many runs: their speeds, files and answers."""
