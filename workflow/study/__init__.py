"""Studies of accuracy, mesh, bases and stability: numbers, tables, pictures."""
