"""Version of the distribution, in one place for the stored results."""

__version__ = "0.1.0"
