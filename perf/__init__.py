"""Measurements; see README.md. The folders of modules that they import are on the path, see __main__.py."""
