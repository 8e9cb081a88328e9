"""Machine code of numerical functions that stay Python (the language: LANGUAGE.md).

The syntax trees of such functions are read as they are. Every value's kind follows in one
pass, and each function becomes LLVM's text once for each combination of kinds that it is
called with. llvmlite makes machine code of the text, which is kept on disk. Interpreted,
the same functions give the same bits: Python is the oracle, and the debugger.

`values` are what a name may stand for, and how it stands in LLVM; `expressions`, with the
functions of `mathematics`, and `statements` write the text of one function; `functions`
makes all that a function calls into one program; `objects` makes, keeps, loads and calls
machine code. Nothing here knows what is computed with it.
"""
