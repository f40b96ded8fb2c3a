"""`python -m sunpeak`: the command line."""

from sunpeak.cli import main

if __name__ == "__main__":
    main()
