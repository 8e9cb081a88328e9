"""The version of rps; the package, its citation and all documents have it from here."""

VERSION = "1.0.0"
