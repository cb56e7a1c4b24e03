"""The paper: its cases, the numbers of its claims, and their verdicts."""
