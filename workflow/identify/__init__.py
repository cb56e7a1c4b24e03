"""Identification: what the paper leaves open, inferred from the critical speeds that it gives."""
