"""What everything stands on: errors, checks, units, tables, answers, files, progress."""
