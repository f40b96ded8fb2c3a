"""Radiance's programs by their own names, options and formats, on Sunpeak's renderer.

`sunpeak compat NAME …` runs one; `sunpeak compat install DIR` puts small programs of their names into a folder, which
goes to the front of PATH. What an option means follows Radiance's manual pages; what each is taken for here, and what
has no meaning, is in `docs/compat.md`.
"""
