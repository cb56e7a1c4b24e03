"""How sure a number is: what a run shows, and its second runs."""
