class MeshFileError(ValueError):
    """A mesh file cannot be used. The text names the file and what is wrong."""
