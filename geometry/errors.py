"""What a geometry that cannot be used says."""


class MeshError(RuntimeError):
    """Geometry or mesh fails a check; the message has the number and the remedy, in one line."""
