"""The format of a case: every key, what it may hold, and what
is wrong with a document.
"""
