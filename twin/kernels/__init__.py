"""Compiled steppers and force laws; a module here compiles when it is imported, so import it where it is used."""
