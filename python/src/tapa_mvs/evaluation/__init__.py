"""Some modules of the package evaluation, as they stand there; setup.py puts them here."""
