"""How results are written: text formats, folders, versions."""
