"""The compiled core. Shapes are in brackets; angles at the edges are in degrees and say so in their names."""

__version__: str

class InputError(ValueError):
    """The input is wrong: the message says where (file:line:column), what was found, what was expected."""
