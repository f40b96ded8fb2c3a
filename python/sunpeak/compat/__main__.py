"""`python -m sunpeak.compat NAME …`: what the installed programs call."""

import sys

from sunpeak.compat.programs import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
