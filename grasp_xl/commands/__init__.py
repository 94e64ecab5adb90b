"""What each command does, from files to results; the command line speaks with the person."""
